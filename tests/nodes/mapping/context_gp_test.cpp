#include "nodes/mapping/context_gp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "nodes/latent/cholesky.h"
#include "nodes/mapping/context_frames.h"
#include "nodes/mapping/context_gp_inspect.h"
#include "nodes/mapping/context_gp_predict.h"
#include "tests/nodes/mapping/context_corpus.h"

namespace talkgraph {
namespace {

using testing::ContextCorpus;
using testing::gaussian;
using testing::random_corpus;
using testing::rbf;
using testing::said;
using testing::stacked;
using testing::track;

TEST(ContextGp, IsTheTextbooksProcess) {
  const auto corpus = random_corpus();
  const TrainContextGp node{.reach = 2, .width = 1.5, .sound = 0.7, .phones = 1.3, .noise = 0.4};
  const auto model = corpus.learn(node);
  ASSERT_EQ(model.phones, (std::vector<std::string>{"b", "ih", "n"}));

  Eigen::MatrixXd audio(21, 3), z(21, 2);
  audio << corpus.audio[0].values, corpus.audio[1].values;
  z << corpus.visual[0].values, corpus.visual[1].values;
  const Eigen::RowVectorXd mean = audio.colwise().mean();
  const Eigen::RowVectorXd deviation = ((audio.rowwise() - mean).colwise().squaredNorm() / 21).cwiseSqrt();
  const auto described = [&](const Track& a, const PhoneTrack& p) {
    return stacked(node, (a.values.rowwise() - mean).array().rowwise() / deviation.array(),
                   phone_shares(p, model.phones, a));
  };
  const Eigen::MatrixXd first = described(corpus.audio[0], corpus.phones[0]);
  Eigen::MatrixXd x(21, first.cols());
  x << first, described(corpus.audio[1], corpus.phones[1]);
  const Eigen::RowVectorXd z_mean = z.colwise().mean();
  const Eigen::MatrixXd weights =
      (rbf(x, x) + 0.4 * Eigen::MatrixXd::Identity(21, 21)).fullPivLu().solve(z.rowwise() - z_mean);

  const Track heard = track(gaussian(10, 3, 5));
  const auto phones = said({{"ih", 2}, {"b", 4}, {"n", 4}});
  const Eigen::MatrixXd expected = (rbf(described(heard, phones), x) * weights).rowwise() + z_mean;
  const auto [visual, variance] = PredictContextGp{}(model, heard, phones);
  EXPECT_LT((visual.values - expected).norm(), 1e-9 * expected.norm());
  EXPECT_DOUBLE_EQ(visual.start, 0.02);

  // All frames are inducing ones, so that the approximate variance is the exact one.
  const Eigen::MatrixXd covariance = rbf(x, x) + 0.4 * Eigen::MatrixXd::Identity(21, 21),
                        k = rbf(described(heard, phones), x);
  const Eigen::RowVectorXd signal =
      (z.rowwise() - z_mean).cwiseProduct(covariance.fullPivLu().solve(z.rowwise() - z_mean)).colwise().mean();
  const Eigen::VectorXd unknown = (1.4 - (k * covariance.fullPivLu().solve(k.transpose())).diagonal().array()).matrix();
  EXPECT_LT((variance.values - unknown * signal).norm(), 1e-5 * variance.values.norm());
  EXPECT_DOUBLE_EQ(variance.start, 0.02);
}

/// With fewer inducing frames: the deterministic training conditional, which never knows more than the process.
TEST(ContextGp, VarianceByFewerFrames) {
  const auto corpus = random_corpus();
  const Track heard = track(gaussian(10, 3, 5));
  const auto phones = said({{"ih", 2}, {"b", 4}, {"n", 4}});
  const auto variance = [&](int inducing) {
    return PredictContextGp{}(corpus.learn({.noise = 0.1, .inducing = inducing}), heard, phones).variance.values;
  };
  const Eigen::MatrixXd exact = variance(21), fewer = variance(7), one = variance(1);
  EXPECT_EQ(variance(1000), exact);
  EXPECT_TRUE(((fewer - exact).array() > -1e-5 * exact.array()).all());
  EXPECT_TRUE(((one - fewer).array() > -1e-5 * exact.array()).all());
  EXPECT_GT((one - exact).norm(), 0.01 * exact.norm());
}

/// Of recordings drawn from a process: as far off as the variance says.
TEST(ContextGp, IsAsFarOffAsItSays) {
  const auto sine = [](int clip) {
    Track audio = track(Eigen::MatrixXd(100, 1)), visual = audio;
    const Eigen::MatrixXd noise = gaussian(100, 1, 50 + clip);
    for (int t = 0; t < 100; ++t) {
      audio.values(t, 0) = std::sin(0.2 * t + clip) + std::sin(0.07 * t * (1 + clip % 3));
      visual.values(t, 0) = std::sin(2 * audio.values(t, 0)) + 0.5 * noise(t, 0);
    }
    return std::pair{audio, visual};
  };
  ContextCorpus corpus;
  for (int clip = 0; clip < 6; ++clip)
    corpus.add(std::to_string(clip), sine(clip).first, said({{"b", 100}}), sine(clip).second);
  const auto model = corpus.learn({.reach = 0, .sound = 20, .noise = 0.5});
  const auto [audio, truth] = sine(7);
  const auto [visual, variance] = PredictContextGp{}(model, audio, said({{"b", 100}}));
  const double off = ((truth.values - visual.values).array().square() / variance.values.array()).mean();
  EXPECT_GT(off, 0.6);
  EXPECT_LT(off, 1.5);
}

/// The sound tells nothing; the lips round for the vowel before it is heard.
TEST(ContextGp, KnowsTheNextPhone) {
  ContextCorpus corpus;
  const Track silent_sound = track(Eigen::MatrixXd::Zero(8, 1));
  for (int i = 0; i < 6; ++i) {
    const bool round = i % 2;
    corpus.add(std::to_string(i), silent_sound, said({{"t", 4}, {round ? "uw" : "iy", 4}}),
               track(Eigen::MatrixXd::Constant(8, 1, round ? 1 : -1)));
  }
  const auto next = said({{"t", 4}, {"uw", 4}});
  const auto model = corpus.learn({.reach = 4, .width = 3, .noise = 0.01});
  EXPECT_GT(PredictContextGp{}(model, silent_sound, next).visual.values(2, 0), 0.8);
  const auto deaf = corpus.learn({.reach = 4, .width = 3, .phones = 0, .noise = 0.01});
  EXPECT_NEAR(PredictContextGp{}(deaf, silent_sound, next).visual.values(2, 0), 0, 1e-9);
}

/// The same is heard and said all the time, but the head sinks as a recording goes on and rises where speech ends.
TEST(ContextGp, KnowsThePlaceInTheRecording) {
  ContextCorpus corpus;
  const auto sound = [](int frames) { return track(Eigen::MatrixXd::Zero(frames, 1)); };
  const auto nodding = [](int frames) {
    Eigen::MatrixXd z(frames, 1);
    for (int t = 0; t < frames; ++t) z(t, 0) = std::exp(-t / 10.0) + std::exp((t - frames) / 10.0);
    return z;
  };
  for (const int frames : {60, 70, 80})
    corpus.add(std::to_string(frames), sound(frames), said({{"aa", frames}}), track(nodding(frames)));
  const auto off = [&](const TrainContextGp& node, int frames) {
    const auto said_so = PredictContextGp{}(corpus.learn(node), sound(frames), said({{"aa", frames}}));
    return (said_so.visual.values - nodding(frames)).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(off({.reach = 2, .place = 4, .place_time = 0.4, .noise = 0.01}, 75), 0.1);
  EXPECT_LT(off({.reach = 2, .place = 4, .place_time = 0.4, .noise = 0.01}, 200), 0.1);  // longer than all it learnt
  EXPECT_GT(off({.reach = 2, .noise = 0.01}, 75), 0.5);
}

/// Of two streams of sound one moves the lips, of three phones two look alike.
ContextCorpus with_noise_beside(int from, int to) {
  ContextCorpus corpus;
  for (int i = from; i < to; ++i) {
    const Eigen::MatrixXd sound = gaussian(24, 2, 100 + i);
    const bool b = i % 2;
    Eigen::MatrixXd face(24, 1);
    face << sound.col(0).head(12).array().tanh(), 2 + sound.col(0).tail(12).array().tanh();
    corpus.add(std::to_string(i), track(sound), said({{b ? "b" : "p", 12}, {"aa", 12}}), track(face));
  }
  return corpus;
}

TEST(ContextGp, LearnsItsKernel) {
  const auto corpus = with_noise_beside(0, 10), unmet = with_noise_beside(10, 14);
  const TrainContextGp node{.reach = 1, .width = 1, .noise = 0.1, .kernel_utterances = 6, .inducing = 30};
  const auto model = corpus.learn(node, 40);
  const auto error = [&](const ContextGp& m) {
    double squares = 0;
    for (std::size_t u = 0; u < unmet.audio.size(); ++u)
      squares +=
          (PredictContextGp{}(m, unmet.audio[u], unmet.phones[u]).visual.values - unmet.visual[u].values).squaredNorm();
    return squares;
  };
  EXPECT_LT(error(model), 0.7 * error(corpus.learn(node)));
  EXPECT_GT(model.map.row(0).norm(), 1.5 * model.map.row(1).norm());
  ASSERT_EQ(model.phones, (std::vector<std::string>{"aa", "b", "p"}));
  const auto apart = [&](int i, int j) { return (model.map.row(2 + i) - model.map.row(2 + j)).norm(); };
  EXPECT_LT(apart(1, 2), apart(0, 1));
  EXPECT_LT(apart(1, 2), apart(0, 2));
  EXPECT_EQ(corpus.learn(node, 40).map, model.map);
}

/// As given, any two phones cost `phones`, a deviation of all dimensions half of `sound`.
TEST(ContextGp, CostsAreThoseGiven) {
  const auto model = random_corpus().learn({.reach = 1, .width = 1, .sound = 0.6, .phones = 2});
  const auto [phones, sound, place, window] = InspectContextGp{}(model);
  EXPECT_EQ(phones.rows, (std::vector<std::string>{"b - ih", "b - n", "ih - n"}));
  for (const auto& row : phones.cells) EXPECT_NEAR(row[0], 2, 1e-12);
  ASSERT_EQ(sound.rows, (std::vector<std::string>{"1", "2", "3"}));
  for (const auto& row : sound.cells) EXPECT_NEAR(row[0], 0.1, 1e-12);
  ASSERT_EQ(window.rows, (std::vector<std::string>{"-1", "0", "1"}));
  EXPECT_NEAR(window.cells[0][0], std::exp(-1) / (1 + 2 * std::exp(-1)), 1e-12);
  EXPECT_EQ(place.rows.size(), 0u);
  const auto placed = InspectContextGp{}(random_corpus().learn({.place = 3}));
  ASSERT_EQ(placed.place.rows, (std::vector<std::string>{"its start", "the end of speech"}));
  for (const auto& row : placed.place.cells) EXPECT_NEAR(row[0], 3, 1e-12);
  EXPECT_EQ(placed.phones.rows, phones.rows);
  EXPECT_EQ(InspectContextGp{}(ContextGp{}).phones.rows.size(), 0u);
}

TEST(ContextGp, TellsWhatItHoldsAlike) {
  const auto model = with_noise_beside(0, 10).learn(
      {.reach = 1, .width = 1, .noise = 0.1, .kernel_utterances = 6, .inducing = 30}, 40);
  const auto [phones, sound, place, window] = InspectContextGp{}(model);
  ASSERT_EQ(phones.rows.size(), 3u);
  EXPECT_EQ(phones.rows[0], "b - p");
  EXPECT_LT(phones.cells[0][0], phones.cells[1][0]);
  EXPECT_LE(phones.cells[1][0], phones.cells[2][0]);
  EXPECT_GT(sound.cells[0][0], sound.cells[1][0]);
}

TEST(ContextGp, KeepsItsKernelWhereNoUtteranceCanBeLeftOut) {
  ContextCorpus corpus = random_corpus();
  corpus.phones = {};
  corpus.phones.add("a", said({{"b", 12}}));
  corpus.phones.add("b", said({{"sil", 9}}));
  std::vector<std::string> warnings;
  Context context;
  context.on_warning = [&](std::string_view text) { warnings.emplace_back(text); };
  Random random(1);
  const auto model = TrainContextGp{}(corpus.audio, corpus.phones, corpus.visual, random, context);
  EXPECT_EQ(model.map, corpus.learn({}).map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("fewer than two utterances with speech"));
}

TEST(ContextGp, AnswersToPhonesAndSoundItHasNotMet) {
  const auto model = random_corpus().learn({});
  const auto predicted = PredictContextGp{}(model, track(Eigen::MatrixXd::Constant(5, 3, 1e6)), said({{"zh", 5}}));
  EXPECT_LT((predicted.visual.values.rowwise() - model.mean).norm(), 1e-9);
  EXPECT_LT((predicted.variance.values.rowwise() - (1 + model.noise) * model.signal).norm(), 1e-9);
  EXPECT_EQ(PredictContextGp{}(model, track(Eigen::MatrixXd(0, 3)), {}).visual.values.rows(), 0);
}

TEST(ContextGp, SaysWhatIsWrong) {
  EXPECT_THROW(ContextCorpus{}.learn({}), std::runtime_error);
  ContextCorpus unpaired = random_corpus();
  unpaired.phones = {};
  EXPECT_THROW(unpaired.learn({}), std::runtime_error);

  const auto with = [](Track audio, Track visual) {
    auto corpus = random_corpus();
    corpus.add("c", std::move(audio), said({{"b", 4}}), std::move(visual));
    return corpus;
  };
  EXPECT_THROW(with(track(gaussian(4, 2, 1)), track(gaussian(4, 2, 1))).learn({}), std::runtime_error);
  EXPECT_THROW(with(track(gaussian(4, 3, 1)), track(gaussian(8, 2, 1))).learn({}), std::runtime_error);
  auto broken = gaussian(4, 3, 1);
  broken(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(with(track(broken), track(gaussian(4, 2, 1))).learn({}), std::runtime_error);

  ContextCorpus lost;
  auto visual = track(gaussian(3, 2, 1));
  visual.lost = {0, 1, 2};
  lost.add("a", track(gaussian(3, 3, 1)), said({{"b", 3}}), visual);
  EXPECT_THROW(lost.learn({}), std::runtime_error);

  EXPECT_THROW(random_corpus().learn({.noise = -1}), FactorisationError);

  const auto model = random_corpus().learn({});
  EXPECT_THROW(PredictContextGp{}(model, track(gaussian(4, 2, 1)), said({{"b", 4}})), std::runtime_error);
  EXPECT_THROW(PredictContextGp{}(model, track(broken), said({{"b", 4}})), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
