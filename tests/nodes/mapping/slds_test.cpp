#include "nodes/mapping/slds.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "nodes/latent/lds.h"
#include "nodes/mapping/slds_decode.h"
#include "nodes/mapping/slds_synthesise.h"
#include "nodes/types/paired.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::positive;

constexpr Eigen::Index heard = 2, seen = 3;

/// Two phones whose states turn opposite ways, heard in two dimensions and seen in three.
Slds truth() {
  Slds model;
  model.audio = {Eigen::RowVector2d(1, 2), Eigen::RowVector2d(3, 1)};
  model.visual = {Eigen::RowVector3d(-1, 0, 1), Eigen::RowVector3d(1, 2, 0.5)};
  for (const double turn : {0.4, -0.3}) {
    Lds m;
    m.prediction.resize(2, 2);
    m.prediction << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    m.prediction *= 0.9;
    m.offset = 0.2 * Eigen::Vector2d(turn, -turn);
    m.prediction_noise = 0.05 * positive(2, 1);
    m.first_mean = Eigen::Vector2d(0.2, turn);
    m.first_covariance = 0.1 * positive(2, 2);
    m.mean = Eigen::RowVectorXd::Zero(heard + seen);
    m.observation = gaussian(heard + seen, 2, 4) + 0.3 * turn * gaussian(heard + seen, 2, 5);
    m.observation_noise = 0.1 * Eigen::MatrixXd::Identity(heard + seen, heard + seen);
    model.phones[turn > 0 ? "a" : "b"] = m;
  }
  model.shared = model.phones["a"];
  model.chain = {{"a", "b"}, Eigen::Vector2d(0.7, 0.3), Eigen::MatrixXd(2, 2)};
  model.chain.transitions << 0.8, 0.2, 0.3, 0.7;
  return model;
}

struct Corpus {
  Collected<Track> audio, visual;
  Collected<FrameLabels> labels;
};

Corpus sample(const Slds& model, int sequences, int length, std::uint64_t seed) {
  const auto noise = [&](const Eigen::MatrixXd& covariance) -> Eigen::VectorXd {
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    return root * gaussian(covariance.rows(), 1, ++seed);
  };
  Random random(seed);
  Corpus corpus;
  for (int i = 0; i < sequences; ++i) {
    Track audio, visual;
    audio.values.resize(length, heard);
    visual.values.resize(length, seen);
    FrameLabels labels;
    Eigen::VectorXd x;
    bool a = random.uniform() < model.chain.start[0];
    for (int t = 0; t < length; ++t) {
      if (t > 0) a = random.uniform() < model.chain.transitions(a ? 0 : 1, 0);
      labels.labels.push_back(a ? "a" : "b");
      const Lds& m = model.phones.at(labels.labels.back());
      x = t == 0 ? Eigen::VectorXd(m.first_mean + noise(m.first_covariance))
                 : Eigen::VectorXd(m.prediction * x + m.offset + noise(m.prediction_noise));
      const Eigen::RowVectorXd frame = (m.observation * x + noise(m.observation_noise)).transpose();
      audio.values.row(t) = frame.head(heard).cwiseProduct(model.audio.deviation) + model.audio.mean;
      visual.values.row(t) = frame.tail(seen).cwiseProduct(model.visual.deviation) + model.visual.mean;
    }
    corpus.audio.add(std::to_string(i), std::move(audio));
    corpus.visual.add(std::to_string(i), std::move(visual));
    corpus.labels.add(std::to_string(i), std::move(labels));
  }
  return corpus;
}

/// The same, of the face alone.
Slds of_face(Slds model) {
  model.audio = {};
  for (auto& [phone, system] : model.phones) system = observed_part(system, heard, seen);
  model.shared = observed_part(model.shared, heard, seen);
  return model;
}

double squared_error(const Corpus& corpus, const Slds& model, bool smooth) {
  double sum = 0, values = 0;
  for (std::size_t i = 0; i < corpus.audio.size(); ++i) {
    const Track face = SynthesiseSlds{smooth}(model, corpus.audio[i], corpus.labels[i]);
    sum += (face.values - corpus.visual[i].values).squaredNorm();
    values += static_cast<double>(face.values.size());
  }
  return sum / values;
}

TrainSlds node(bool sound) {
  TrainSlds train;
  train.sound = sound;
  train.latent_dimension = 2;
  train.iterations = 60;
  train.tolerance = 1e-5;
  return train;
}

/// Mean and covariances at some lags of the frames of a phone that lasts, scaled as the truth's are: what all systems
/// have in common that say the same of what is observed.
struct Moments {
  Eigen::VectorXd mean, noise;  ///< noise: variances of observation
  std::vector<Eigen::MatrixXd> lagged;
};
Moments moments(const Slds& model, const std::string& phone, bool sound) {
  const auto joined = [&](const Eigen::RowVectorXd& audio, const Eigen::RowVectorXd& visual) {
    Eigen::VectorXd all(visual.size() + (sound ? audio.size() : 0));
    all << (sound ? audio : Eigen::RowVectorXd()).transpose(), visual.transpose();
    return all;
  };
  const Slds like = truth();
  const Eigen::VectorXd deviations = joined(model.audio.deviation, model.visual.deviation),
                        units = joined(like.audio.deviation, like.visual.deviation).cwiseInverse(),
                        ratio = deviations.cwiseProduct(units);
  const Lds& m = model.phones.at(phone);
  Eigen::MatrixXd spread = m.first_covariance;
  for (int i = 0; i < 500; ++i) spread = m.prediction * spread * m.prediction.transpose() + m.prediction_noise;
  const Eigen::VectorXd at = (Eigen::MatrixXd::Identity(2, 2) - m.prediction).inverse() * m.offset;
  const Eigen::VectorXd shift = joined(model.audio.mean, model.visual.mean) - joined(like.audio.mean, like.visual.mean);
  Moments all{ratio.cwiseProduct(m.mean.transpose() + m.observation * at) + shift.cwiseProduct(units),
              m.observation_noise.diagonal().cwiseProduct(ratio.cwiseAbs2()),
              {}};
  for (int lag = 0; lag < 4; ++lag) {
    Eigen::MatrixXd covariance = m.observation * spread * m.observation.transpose();
    if (lag == 0) covariance += m.observation_noise;
    all.lagged.emplace_back(ratio.asDiagonal() * covariance * ratio.asDiagonal());
    spread = m.prediction * spread;
  }
  return all;
}

TEST(Slds, RecoversTheModelItsDataWereDrawnFrom) {
  Context context;
  const Corpus corpus = sample(truth(), 100, 60, 1);
  for (const bool sound : {false, true}) {
    TrainSlds train = node(sound);
    train.iterations = 300;
    train.tolerance = 1e-7;
    const Slds model = train(corpus.audio, corpus.visual, corpus.labels, context);
    for (const std::string phone : {"a", "b"}) {
      const Moments found = moments(model, phone, sound),
                    right = moments(sound ? truth() : of_face(truth()), phone, sound);
      EXPECT_LT((found.mean - right.mean).cwiseAbs().maxCoeff(), 0.1);
      EXPECT_LT((found.noise - right.noise).cwiseAbs().maxCoeff(), 0.02) << "of 0.1";
      for (std::size_t lag = 0; lag < 4; ++lag)
        EXPECT_LT((found.lagged[lag] - right.lagged[lag]).cwiseAbs().maxCoeff(),
                  0.1 * right.lagged[lag].cwiseAbs().maxCoeff())
            << "lag " << lag;
    }
    EXPECT_NEAR(model.chain.start[0], 0.7, 0.1);
    EXPECT_LT((model.chain.transitions - truth().chain.transitions).cwiseAbs().maxCoeff(), 0.03);
  }
}

TEST(Slds, PredictsNearlyAsWellAsTheModelItsDataWereDrawnFrom) {
  Context context;
  const Corpus corpus = sample(truth(), 20, 60, 1), unseen = sample(truth(), 20, 60, 1'000'000);
  for (const bool sound : {false, true}) {
    const Slds model = node(sound)(corpus.audio, corpus.visual, corpus.labels, context);
    EXPECT_EQ(model.phones.size(), 2U);
    const Slds best = sound ? truth() : of_face(truth());
    for (const bool smooth : {false, true})
      EXPECT_LT(squared_error(unseen, model, smooth), 1.05 * squared_error(unseen, best, smooth));
    for (const auto& [phone, system] : model.phones) {
      const auto pole = [](const Lds& m) { return std::complex<double>(m.prediction.eigenvalues()(0)); };
      EXPECT_NEAR(std::abs(pole(system)), 0.9, 0.04);
      EXPECT_NEAR(std::abs(std::arg(pole(system))), phone == "a" ? 0.4 : 0.3, 0.06);
    }
  }
}

TEST(Slds, SoundAndSmoothingHelp) {
  const Corpus corpus = sample(truth(), 20, 60, 1);
  const double face = squared_error(corpus, of_face(truth()), true);
  const double filtered = squared_error(corpus, truth(), false), smoothed = squared_error(corpus, truth(), true);
  EXPECT_LT(filtered, 0.8 * face);
  EXPECT_LT(smoothed, 0.98 * filtered);
}

TEST(Slds, OfTheFaceAlonePredictsItsMeans) {
  const Slds model = of_face(truth());
  Track audio;
  audio.values.setZero(3, 1);
  audio.rate = Rational(30);
  audio.start = 0.5;
  const Track face = SynthesiseSlds{}(model, audio, {{"b", "a", "a"}, 30});
  const Lds &a = model.phones.at("a"), &b = model.phones.at("b");
  const Eigen::VectorXd x = a.prediction * (a.prediction * b.first_mean + a.offset) + a.offset;
  const Eigen::RowVectorXd z = (a.observation * x).transpose();
  EXPECT_TRUE(face.values.row(2).isApprox(z.cwiseProduct(model.visual.deviation) + model.visual.mean, 1e-12));
  EXPECT_EQ(face.rate, Rational(30));
  EXPECT_EQ(face.start, 0.5);
}

TEST(Slds, LikelihoodNeverFallsAndBitsRepeat) {
  Context context;
  const Corpus corpus = sample(truth(), 4, 40, 7);
  for (const bool sound : {false, true})
    for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal}) {
      TrainSlds train = node(sound);
      train.covariance = kind;
      train.latent_dimension = 3;
      const Slds model = train(corpus.audio, corpus.visual, corpus.labels, context);
      EXPECT_GT(model.trace.size(), 3U);
      EXPECT_LT(testing::largest_fall(model.trace), 1e-10);
      EXPECT_GE(model.trace.front(), model.shared.trace.back() - 1e-9 * std::abs(model.shared.trace.back()));
      EXPECT_EQ(train(corpus.audio, corpus.visual, corpus.labels, context).trace, model.trace);
    }
}

TEST(Slds, PhonesOfFewFramesAndUnknownOnesHaveTheSystemOfAll) {
  Context context;
  Corpus corpus = sample(truth(), 4, 40, 7);
  FrameLabels labels = corpus.labels[3];
  for (std::size_t t = 10; t < 19; ++t) labels.labels[t] = "c";
  Collected<FrameLabels> changed;
  for (std::size_t i = 0; i < 4; ++i) changed.add(std::to_string(i), i == 3 ? labels : corpus.labels[i]);
  TrainSlds train = node(true);
  train.min_frames = 10;
  const Slds model = train(corpus.audio, corpus.visual, changed, context);
  EXPECT_EQ(model.phones.size(), 2U);
  EXPECT_EQ(&system_of(model, "c"), &model.shared);
  train.min_frames = 9;
  const Slds more = train(corpus.audio, corpus.visual, changed, context);
  EXPECT_EQ(&system_of(more, "c"), &more.phones.at("c"));
  EXPECT_NE(system_of(more, "c").prediction, more.shared.prediction);
  EXPECT_TRUE(SynthesiseSlds{}(more, corpus.audio[0], {std::vector<std::string>(40, "x"), 25}).values.allFinite());
}

/// ln p(frames, phones).
double score_of(const Slds& model, SldsStream stream, const Track& track, const std::vector<std::string>& phones) {
  const bool audio = stream == SldsStream::audio;
  const Scaling& scaling = audio ? model.audio : model.visual;
  const Eigen::MatrixXd frames =
      (track.values.rowwise() - scaling.mean) * scaling.deviation.cwiseInverse().asDiagonal();
  std::map<std::string, Lds> systems;
  for (const std::string& phone : phones) {
    const Lds& system = system_of(model, phone);
    systems[phone] = audio ? observed_part(system, 0, heard) : observed_part(system, system.dimension() - seen, seen);
  }
  LdsRegimes regimes;
  double score = 0;
  Eigen::Index before = 0;
  for (std::size_t t = 0; t < phones.size(); ++t) {
    const Eigen::Index k = phones[t] == "a" ? 0 : 1;
    score += std::log(t == 0 ? model.chain.start[k] : model.chain.transitions(before, k));
    regimes.push_back(&systems.at(phones[t]));
    before = k;
  }
  return score + kalman_filter(regimes, frames, track.lost).log_likelihood;
}

/// The likeliest phones, of all sequences one by one.
std::vector<std::string> likeliest(const Slds& model, SldsStream stream, const Track& track) {
  double most = -std::numeric_limits<double>::infinity();
  std::vector<std::string> best;
  for (unsigned code = 0; code < 1U << track.frames(); ++code) {
    std::vector<std::string> phones;
    for (unsigned t = 0; t < track.frames(); ++t) phones.emplace_back((code >> t & 1U) != 0 ? "b" : "a");
    const double score = score_of(model, stream, track, phones);
    if (score <= most) continue;
    most = score;
    best = phones;
  }
  return best;
}

Track without(Track track, std::vector<std::int64_t> lost) {
  for (const auto t : lost) track.values.row(t).setConstant(1e9);
  track.lost = std::move(lost);
  return track;
}

TEST(SldsDecode, FindsThePhonesThatASearchOfAllSequencesFinds) {
  Context context;
  Slds model = truth();
  model.phones["b"].offset = -3 * model.phones["a"].offset;
  const Corpus corpus = sample(model, 20, 9, 4);
  for (const auto stream : {SldsStream::visual, SldsStream::audio})
    for (const auto& lost : std::vector<std::vector<std::int64_t>>{{}, {0}, {3, 4}}) {
      int agree = 0;
      double missed = 0;
      for (std::size_t i = 0; i < 20; ++i) {
        const Track track = without(stream == SldsStream::audio ? corpus.audio[i] : corpus.visual[i], lost);
        const auto best = likeliest(model, stream, track), found = DecodeSlds{stream}(model, track, context).labels;
        const double most = score_of(model, stream, track, best), reached = score_of(model, stream, track, found);
        EXPECT_LE(reached, most + 1e-9);
        missed += most - reached;
        agree += found == best;
      }
      EXPECT_GE(agree, 14);
      EXPECT_LT(missed / 20, 0.3);
    }
}

TEST(SldsDecode, IsExactForTwoFrames) {
  Context context;
  const Corpus corpus = sample(truth(), 30, 2, 4);
  for (std::size_t i = 0; i < 30; ++i)
    EXPECT_EQ(DecodeSlds{}(truth(), corpus.visual[i], context).labels,
              likeliest(truth(), SldsStream::visual, corpus.visual[i]));
}

TEST(SldsDecode, OfLostFramesAloneGivesTheLikeliestPhones) {
  Context context;
  const Track lost = without(sample(truth(), 1, 4, 4).visual[0], {0, 1, 2, 3});
  EXPECT_EQ(DecodeSlds{}(truth(), lost, context).labels, (std::vector<std::string>(4, "a")));
}

TEST(SldsDecode, PhonesThatShareASystemAreToldApartByTheChain) {
  Context context;
  Slds model = truth();
  model.phones.clear();
  const Track face = sample(truth(), 1, 6, 4).visual[0];
  EXPECT_EQ(DecodeSlds{}(model, face, context).labels, (std::vector<std::string>(6, "a")));
  model.chain.start = Eigen::Vector2d(0.1, 0.9);
  model.chain.transitions << 0.5, 0.5, 0.05, 0.95;
  EXPECT_EQ(DecodeSlds{}(model, face, context).labels, (std::vector<std::string>(6, "b")));
}

TEST(SldsDecode, StatesThatOverflowAreRefusedNotDecoded) {
  Context context;
  Slds model = truth();
  for (auto& [phone, system] : model.phones) system.prediction *= 30;
  std::vector<std::int64_t> gap(300);
  std::iota(gap.begin(), gap.end(), 20);
  const Track face = without(sample(truth(), 1, 400, 4).visual[0], gap);
  EXPECT_THROW(DecodeSlds{}(model, face, context), std::runtime_error);
}

TEST(SldsDecode, FindsPhonesAsWellAsTheModelItsDataWereDrawnFrom) {
  Context context;
  Slds model = truth();
  model.phones["a"].offset = Eigen::Vector2d(1, 1);
  model.phones["b"].offset = Eigen::Vector2d(-1, -1);
  const Corpus corpus = sample(model, 20, 60, 9), unseen = sample(model, 5, 60, 1'000'000);
  const Slds learnt = node(true)(corpus.audio, corpus.visual, corpus.labels, context);
  EXPECT_EQ(learnt.chain.phones, model.chain.phones);
  EXPECT_LT((learnt.chain.transitions - model.chain.transitions).cwiseAbs().maxCoeff(), 0.05);
  for (const auto stream : {SldsStream::visual, SldsStream::audio}) {
    const auto right = [&](const Slds& by) {
      int count = 0;
      for (std::size_t i = 0; i < 5; ++i) {
        const Track& track = stream == SldsStream::audio ? unseen.audio[i] : unseen.visual[i];
        const FrameLabels found = DecodeSlds{stream}(by, track, context);
        for (std::size_t t = 0; t < 60; ++t) count += found.labels[t] == unseen.labels[i].labels[t];
      }
      return count;
    };
    EXPECT_GE(right(model), 270);
    EXPECT_GE(right(learnt), right(model) - 5);
  }
}

TEST(SldsDecode, RefusesWhatItCannotUse) {
  Context context;
  const Corpus corpus = sample(truth(), 1, 5, 4);
  Track face = corpus.visual[0];
  EXPECT_EQ(DecodeSlds{}(truth(), beginning(face, 1), context).labels.size(), 1U);
  EXPECT_TRUE(DecodeSlds{}(truth(), beginning(face, 0), context).labels.empty());
  EXPECT_THROW(DecodeSlds{SldsStream::audio}(truth(), face, context), std::runtime_error);
  EXPECT_THROW(DecodeSlds{SldsStream::audio}(of_face(truth()), corpus.audio[0], context), std::runtime_error);
  face.values(2, 1) = NAN;
  EXPECT_THROW(DecodeSlds{}(truth(), face, context), std::runtime_error);
}

TEST(Slds, LearnsNothingFromLostFramesAndBridgesLostSound) {
  Context context;
  const Corpus corpus = sample(truth(), 2, 60, 5);
  Track face = corpus.visual[1], sound = corpus.audio[0];
  face.values.row(20).setConstant(1e6);
  face.lost = {20};
  const Slds model = node(true)(corpus.audio, {{"0", corpus.visual[0]}, {"1", face}}, corpus.labels, context);
  EXPECT_LT(model.visual.deviation.maxCoeff(), 100);
  sound.values.row(9).setConstant(1e6);
  sound.lost = {9};
  EXPECT_LT(SynthesiseSlds{}(model, sound, corpus.labels[0]).values.cwiseAbs().maxCoeff(), 100);
}

TEST(Slds, ALongPhoneComesToRest) {
  Context context;
  Corpus corpus = sample(truth(), 2, 60, 5);
  Track rise;
  rise.values = Eigen::MatrixXd::NullaryExpr(
      60, seen, [](Eigen::Index t, Eigen::Index d) { return std::pow(1.5, t % 6) + static_cast<double>(d); });
  FrameLabels labels;
  for (int t = 0; t < 60; ++t) labels.labels.push_back(t % 6 == 0 ? "b" : "a");
  TrainSlds train = node(false);
  train.min_frames = 10;
  train.tolerance = 0;
  const Slds model = train(corpus.audio, {{"0", rise}}, {{"0", labels}}, context);
  EXPECT_NEAR(model.phones.at("a").prediction.eigenvalues().cwiseAbs().maxCoeff(), train.bound, 0.01);
  EXPECT_LT(testing::largest_fall(model.trace), 1e-10);
  EXPECT_LT(testing::largest_fall(model.shared.trace), 1e-10);
  Track sound;
  sound.values.setZero(3000, heard);
  const Track face = SynthesiseSlds{}(model, sound, {std::vector<std::string>(3000, "a"), 25});
  EXPECT_TRUE(face.values.allFinite());
  EXPECT_TRUE(face.values.row(2999).isApprox(face.values.row(2900), 1e-3));
}

TEST(Slds, AnswersDegenerateData) {
  Context context;
  TrainSlds train;
  train.min_frames = 1;
  for (const bool sound : {false, true}) {
    train.sound = sound;
    const auto answer = [&](const Corpus& c) {
      const Slds model = train(c.audio, c.visual, c.labels, context);
      Track face = SynthesiseSlds{}(model, c.audio[0], c.labels[0]);
      EXPECT_TRUE(face.values.allFinite());
      return face;
    };
    const Corpus one = sample(truth(), 1, 1, 1);
    EXPECT_TRUE(answer(one).values.isApprox(one.visual[0].values, 1e-9));
    answer(sample(truth(), 1, 3, 1));
    Corpus still = sample(truth(), 1, 30, 1);
    Track silence = still.audio[0], face = still.visual[0];
    silence.values.setConstant(-7);
    face.values.setConstant(0.3);
    still.audio = {{"0", silence}};
    still.visual = {{"0", face}};
    EXPECT_TRUE(answer(still).values.isApproxToConstant(0.3, 1e-9));
    silence.values.resize(0, heard);
    const Slds model = train(still.audio, still.visual, still.labels, context);
    EXPECT_EQ(SynthesiseSlds{}(model, silence, {}).dimension(), seen);
  }
}

TEST(Slds, RefusesWhatItCannotUse) {
  Context context;
  const Corpus c = sample(truth(), 2, 60, 1);
  EXPECT_THROW(node(true)({}, c.visual, c.labels, context), std::runtime_error);
  EXPECT_THROW(node(true)(c.audio, c.visual, {}, context), std::runtime_error);
  Track wrong = c.visual[0];
  wrong.values(3, 1) = NAN;
  EXPECT_THROW(node(false)(c.audio, {{"0", wrong}}, c.labels, context), std::runtime_error);
  EXPECT_THROW(node(false)(c.audio, c.visual, {{"0", {std::vector<std::string>(57, "a"), 25}}}, context),
               std::runtime_error);
  const Slds model = node(true)(c.audio, c.visual, c.labels, context);
  Track sound = c.audio[0];
  sound.values(0, 0) = NAN;
  EXPECT_THROW(SynthesiseSlds{}(model, sound, c.labels[0]), std::runtime_error);
  sound.values = gaussian(60, 3, 1);
  EXPECT_THROW(SynthesiseSlds{}(model, sound, c.labels[0]), std::runtime_error);
  sound.values = gaussian(57, 2, 1);
  EXPECT_THROW(SynthesiseSlds{}(model, sound, c.labels[0]), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
