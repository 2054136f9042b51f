#include "nodes/mapping/trajectory_hmm.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "nodes/mapping/scaling.h"
#include "nodes/mapping/trajectory_hmm_synthesise.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

constexpr Eigen::Index heard = 2, seen = 3;

/// Two states of the phones aa, b and s; the face of b is another before s than before others.
TrajectoryHmm truth() {
  TrajectoryHmm model;
  model.audio = {Eigen::RowVectorXd::Zero(heard), Eigen::RowVectorXd::Ones(heard)};
  model.visual = {Eigen::RowVectorXd::Zero(seen), Eigen::RowVectorXd::Ones(seen)};
  model.start = Eigen::Vector2d(0.9, 0.1);
  model.transitions = Eigen::Matrix2d{{0.6, 0.4}, {0, 1}};
  const auto is = [](std::int64_t place, const char* phone, std::int64_t yes) {
    return ContextNode{.place = place, .phone = phone, .yes = yes, .no = yes + 1};
  };
  const auto leaf = [](std::int64_t row) { return ContextNode{.phone = {}, .row = row}; };
  model.sound.nodes = {is(0, "aa", 2), is(0, "aa", 6), leaf(0),       is(0, "b", 4), leaf(1),
                       leaf(2),        leaf(3),        is(0, "b", 8), leaf(4),       leaf(5)};
  model.sound.means.setZero(6, 3 * heard);
  model.sound.means.leftCols(heard) << -3, -3, 3, -3, -3, 3, -3, 0, 3, 3, 0, 3;
  model.sound.variances.setConstant(6, 3 * heard, 0.2);
  model.face = model.sound;
  model.face.nodes[4] = is(1, "s", 10);
  model.face.nodes.push_back(leaf(1));
  model.face.nodes.push_back(leaf(6));
  model.face.means.setZero(7, 3 * seen);
  model.face.means.leftCols(seen) = 2 * gaussian(7, seen, 3);
  model.face.variances.setConstant(7, 3 * seen, 0.1);
  return model;
}

std::vector<std::string> some_phones(Eigen::Index frames, Random& random) {
  std::vector<std::string> labels;
  const std::vector<std::string> names{"aa", "b", "s"};
  for (std::size_t phone = 0; std::ssize(labels) < frames; phone += 1 + random.below(2))
    labels.insert(labels.end(), 1 + random.below(7), names[phone % 3]);
  labels.resize(static_cast<std::size_t>(frames));
  return labels;
}

/// States of every frame inside its phone, as the chain has them.
std::vector<std::size_t> some_states(const TrajectoryHmm& model, const std::vector<std::string>& labels,
                                     Random& random) {
  std::vector<std::size_t> states;
  for (std::size_t t = 0; t < labels.size(); ++t) {
    const bool begins = t == 0 || labels[t] != labels[t - 1];
    const double first = begins ? model.start(0) : model.transitions(static_cast<Eigen::Index>(states.back()), 0);
    states.push_back(random.uniform() < first ? 0 : 1);
  }
  return states;
}

/// A trajectory of the normalised density N(y | ȳ, (WᵀPW)⁻¹) (Zen, Tokuda and Kitamura 2007).
Eigen::MatrixXd drawn(const StateGaussians& states, const StatePath& path, std::uint64_t seed) {
  Eigen::MatrixXd y = trajectory(states, path);
  const Eigen::MatrixXd w = path.rows;
  for (Eigen::Index d = 0; d < y.cols(); ++d) {
    Eigen::VectorXd precisions(w.rows());
    for (Eigen::Index kind = 0; kind < 3; ++kind)
      precisions.segment(kind * y.rows(), y.rows()) =
          states.variances.col(kind * y.cols() + d)(path.states).cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(w.transpose() * precisions.asDiagonal() * w);
    y.col(d) += factor.matrixU().solve(gaussian(y.rows(), 1, seed + static_cast<std::uint64_t>(d)));
  }
  return y;
}

struct Corpus {
  Collected<Track> audio, visual;
  Collected<FrameLabels> labels;
};

Track track_of(Eigen::MatrixXd values) {
  Track track;
  track.values = std::move(values);
  return track;
}

Corpus drawn_from(const TrajectoryHmm& model, int sequences, std::uint64_t seed) {
  Random random(seed);
  Corpus corpus;
  for (int i = 0; i < sequences; ++i) {
    const std::string key = std::to_string(i);
    const FrameLabels labels{some_phones(60, random)};
    const std::vector<std::size_t> states = some_states(model, labels.labels, random);
    StatePath path{frames_slopes_and_curvatures(60), {}, Eigen::VectorXd::Ones(60), {}};
    Eigen::MatrixXd audio = std::sqrt(0.2) * gaussian(60, heard, ++seed);
    for (const PhoneRun& run : phone_runs(labels.labels, {60}))
      for (Eigen::Index t = run.first; t < run.first + run.frames; ++t) {
        const std::size_t state = states[static_cast<std::size_t>(t)];
        path.states.push_back(rows_of(model.face, run.context, 2)[state]);
        audio.row(t) += model.sound.means.row(rows_of(model.sound, run.context, 2)[state]).head(heard);
      }
    corpus.audio.add(key, track_of(audio));
    corpus.visual.add(key, track_of(drawn(face_of(model), path, 100 * ++seed)));
    corpus.labels.add(key, labels);
  }
  return corpus;
}

TrajectoryHmm trained(const Corpus& corpus, int descent = 60) {
  Context context;
  TrainTrajectoryHmm train;
  train.states = 2;
  train.descent = descent;
  return train(corpus.audio, corpus.visual, corpus.labels, context);
}

/// Squared error against the best prediction, as a share of how far that moves.
double error(const TrajectoryHmm& model, const Corpus& corpus) {
  double missed = 0, moved = 0;
  for (std::size_t i = 0; i < corpus.audio.size(); ++i) {
    const auto face = [&](const TrajectoryHmm& m) {
      return SynthesiseTrajectoryHmm{}(m, corpus.audio[i], corpus.labels[i]).values;
    };
    const Eigen::MatrixXd best = face(truth());
    missed += (face(model) - best).squaredNorm();
    moved += (best.rowwise() - best.colwise().mean()).squaredNorm();
  }
  return missed / moved;
}

TEST(TrajectoryHmm, DescentComesCloserToTheTrajectoriesThatTheDataWereDrawnFrom) {
  const Corpus corpus = drawn_from(truth(), 30, 1), unseen = drawn_from(truth(), 20, 1'000'000);
  const TrajectoryHmm likeliest = trained(corpus, 0), refined = trained(corpus, 100);
  EXPECT_LT(error(refined, unseen), 0.03);
  EXPECT_LT(error(refined, unseen), 0.8 * error(likeliest, unseen));
  EXPECT_EQ(likeliest.errors.size(), 1U);
  EXPECT_EQ(likeliest.errors[0], refined.errors[0]);
  EXPECT_EQ(likeliest.sound.means, refined.sound.means);
  EXPECT_LT(testing::largest_fall(refined.trace), 1e-12);
  for (std::size_t i = 1; i < refined.errors.size(); ++i) EXPECT_LE(refined.errors[i], refined.errors[i - 1]);
}

TEST(TrajectoryHmm, FindsTheStatesThatTheDataWereDrawnFrom) {
  const TrajectoryHmm model = trained(drawn_from(truth(), 30, 1), 0), best = truth();
  EXPECT_TRUE(model.start.isApprox(best.start, 0.05)) << model.start;
  EXPECT_TRUE(model.transitions.isApprox(best.transitions, 0.1)) << model.transitions;
  EXPECT_EQ(model.transitions(1, 0), 0);
  for (const PhoneContext& context :
       {PhoneContext{"s", "aa", "b"}, {"aa", "b", "s"}, {"aa", "b", "aa"}, {"b", "s", ""}})
    for (std::size_t state = 0; state < 2; ++state) {
      const auto mean = [&](const TiedGaussians& tied, const Scaling& scaling) {
        const Eigen::RowVectorXd scaled = tied.means.row(rows_of(tied, context, 2)[state]);
        return Eigen::RowVectorXd(scaled.head(heard).cwiseProduct(scaling.deviation) + scaling.mean);
      };
      EXPECT_LT((mean(model.sound, model.audio) - mean(best.sound, best.audio)).cwiseAbs().maxCoeff(), 0.15);
    }
  EXPECT_NE(rows_of(model.face, {"aa", "b", "s"}, 2)[0], rows_of(model.face, {"aa", "b", "aa"}, 2)[0]);
}

TEST(TrajectoryHmm, RecoversTheFacesOfTheStatesThatTheDataWereDrawnFrom) {
  const TrajectoryHmm model = trained(drawn_from(truth(), 60, 1), 100), best = truth();
  // Faces are 4 apart. A Gaussian has some 200 frames, of which smooth trajectories tell less than as many would that
  // are independent. Variances are known up to a factor only.
  for (const PhoneContext& context :
       {PhoneContext{"s", "aa", "b"}, {"aa", "b", "s"}, {"aa", "b", "aa"}, {"b", "s", ""}})
    for (std::size_t state = 0; state < 2; ++state) {
      const auto mean = [&](const TrajectoryHmm& m) {
        return restored(m.visual, m.face.means.row(rows_of(m.face, context, 2)[state]).head(seen));
      };
      EXPECT_LT((mean(model) - mean(best)).cwiseAbs().maxCoeff(), 0.25) << mean(model);
    }
}

TEST(TrajectoryHmm, RecoversTheVariancesThatTheDataWereDrawnWith) {
  TrajectoryHmm best = truth();
  for (Eigen::Index row = 1; row < best.face.variances.rows(); row += 2) best.face.variances.row(row) *= 4;
  best.face.variances.middleCols(seen, seen) *= 0.5;
  const TrajectoryHmm model = trained(drawn_from(best, 120, 1), 200);
  const auto variances = [](const TiedGaussians& tied, const Scaling& scaling, std::size_t row) {
    const Eigen::RowVectorXd squares = scaling.deviation.array().square();
    return Eigen::RowVectorXd(tied.variances.row(static_cast<Eigen::Index>(row)).cwiseProduct(squares.replicate(1, 3)));
  };
  Eigen::MatrixXd ratios(6, 3 * seen);
  Eigen::Index row = 0;
  for (const PhoneContext& context : {PhoneContext{"s", "aa", "b"}, {"aa", "b", "s"}, {"aa", "b", "aa"}})
    for (std::size_t state = 0; state < 2; ++state) {
      const auto of = [&](const TiedGaussians& tied) { return rows_of(tied, context, 2)[state]; };
      EXPECT_TRUE(variances(model.sound, model.audio, of(model.sound)).head(heard).isApproxToConstant(0.2, 0.25));
      ratios.row(row++) = variances(model.face, model.visual, of(model.face))
                              .cwiseQuotient(variances(best.face, best.visual, of(best.face)));
    }
  // A trajectory tells those of one dimension up to a factor, and least of curvatures, which weigh least in it.
  for (Eigen::Index d = 0; d < seen; ++d) {
    const Eigen::ArrayXXd logs = ratios(Eigen::all, Eigen::seqN(d, 3, seen)).array().log();
    const double factor = logs.leftCols(2).mean();
    EXPECT_LT((logs.leftCols(2) - factor).abs().maxCoeff(), std::log(1.4)) << ratios;
    EXPECT_LT((logs.col(2) - factor).abs().maxCoeff(), std::log(2)) << ratios;
  }
}

TEST(TrajectoryHmm, SameBitsEachTime) {
  const Corpus corpus = drawn_from(truth(), 4, 3);
  const TrajectoryHmm a = trained(corpus, 10), b = trained(corpus, 10);
  EXPECT_EQ(a.face.means, b.face.means);
  EXPECT_EQ(a.face.variances, b.face.variances);
  EXPECT_EQ(a.trace, b.trace);
}

TEST(TrajectoryHmm, GivesTheMeansOfStatesThatStay) {
  const TrajectoryHmm model = truth();
  Track audio = track_of(Eigen::RowVector2d(-3, -3).replicate(30, 1));
  audio.rate = Rational(50);
  audio.start = 0.25;
  const Track face = SynthesiseTrajectoryHmm{}(model, audio, {std::vector<std::string>(30, "aa")});
  EXPECT_TRUE(face.values.isApprox(model.face.means.row(0).head(seen).replicate(30, 1), 1e-9));
  EXPECT_EQ(face.rate, Rational(50));
  EXPECT_EQ(face.start, 0.25);
}

TEST(TrajectoryHmm, AnswersWhatTrainingNeverMet) {
  const Corpus corpus = drawn_from(truth(), 10, 5);
  const TrajectoryHmm model = trained(corpus);
  const auto face = [&](const char* phone) {
    return SynthesiseTrajectoryHmm{}(model, track_of(gaussian(4, heard, 1)), {{phone, phone, "", "s"}}).values;
  };
  EXPECT_EQ(face("ae"), face("aa"));  // of one viseme
  EXPECT_EQ(face("z"), face("s"));
  EXPECT_TRUE(face("anything").allFinite());
  const SynthesiseTrajectoryHmm synthesise;
  EXPECT_EQ(synthesise(model, track_of(gaussian(3, heard, 1)), {{"aa"}}).frames(), 1);
  const Track nothing = synthesise(model, track_of(Eigen::MatrixXd(0, heard)), {});
  EXPECT_EQ(nothing.frames(), 0);
  EXPECT_EQ(nothing.dimension(), seen);
}

TEST(TrajectoryHmm, AnswersDegenerateTraining) {
  const auto train = [](const Eigen::MatrixXd& audio, const Eigen::MatrixXd& visual, int states) {
    Context context;
    TrainTrajectoryHmm node;
    node.states = states;
    const FrameLabels labels{std::vector<std::string>(static_cast<std::size_t>(audio.rows()), "aa")};
    const TrajectoryHmm model = node({{"u", track_of(audio)}}, {{"u", track_of(visual)}}, {{"u", labels}}, context);
    return SynthesiseTrajectoryHmm{}(model, track_of(audio), labels).values;
  };
  const Eigen::MatrixXd frame = gaussian(1, seen, 2);
  EXPECT_TRUE(train(gaussian(1, heard, 1), frame, 3).isApprox(frame, 1e-9));
  EXPECT_TRUE(train(gaussian(2, heard, 1), gaussian(2, seen, 2), 5).allFinite());
  EXPECT_TRUE(train(gaussian(20, heard, 1), gaussian(20, seen, 2), 1).allFinite());
  // Silence, and a face that keeps one parameter.
  Eigen::MatrixXd visual = gaussian(20, seen, 2);
  visual.col(1).setConstant(0.1);
  const Eigen::MatrixXd face = train(Eigen::MatrixXd::Zero(20, heard), visual, 3);
  EXPECT_TRUE(face.allFinite());
  EXPECT_TRUE(face.col(1).isApproxToConstant(0.1));
}

TEST(TrajectoryHmm, LearnsNothingFromLostFrames) {
  Corpus corpus = drawn_from(truth(), 3, 5), spoilt = corpus;
  Collected<Track> lost[2];
  for (std::size_t i = 0; i < 3; ++i)
    for (const bool spoil : {false, true}) {
      Track t = corpus.visual[i];
      t.lost = {20, 21};
      if (spoil) t.values.middleRows(20, 2).setConstant(1000);
      lost[spoil].add(corpus.visual.key(i), std::move(t));
    }
  corpus.visual = std::move(lost[0]);
  spoilt.visual = std::move(lost[1]);
  EXPECT_EQ(trained(corpus, 3).face.means, trained(spoilt, 3).face.means);
}

TEST(TrajectoryHmm, SaysWhereItCannotLearnOrSpeak) {
  Context context;
  const TrainTrajectoryHmm train;
  const FrameLabels labels{std::vector<std::string>(9, "aa")};
  const auto learn = [&](const Eigen::MatrixXd& audio, const Eigen::MatrixXd& visual, const char* key) {
    return train({{"u", track_of(audio)}}, {{"u", track_of(visual)}}, {{key, labels}}, context);
  };
  const Eigen::MatrixXd audio = gaussian(9, heard, 1), visual = gaussian(9, seen, 2);
  Eigen::MatrixXd broken = visual;
  broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(learn(audio, broken, "u"), std::runtime_error);
  EXPECT_THROW(learn(audio, visual, "other"), std::runtime_error);
  EXPECT_THROW(learn(gaussian(12, heard, 1), visual, "u"), std::runtime_error);
  EXPECT_THROW(train({}, {}, {}, context), std::runtime_error);
  const TrajectoryHmm model = learn(audio, visual, "u");
  const SynthesiseTrajectoryHmm synthesise;
  EXPECT_THROW(synthesise(model, track_of(gaussian(9, heard + 1, 1)), labels), std::runtime_error);
  EXPECT_THROW(synthesise(model, track_of(gaussian(12, heard, 1)), labels), std::runtime_error);
  EXPECT_THROW(synthesise(model, track_of(Eigen::MatrixXd::Constant(9, heard, NAN)), labels), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
