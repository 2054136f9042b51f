#include "nodes/mapping/dpds.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <limits>

#include "nodes/mapping/dpds_decode.h"
#include "nodes/mapping/dpds_objective.h"
#include "nodes/mapping/dpds_synthesise.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

/// Three phones in two dimensions. Phone "c" begins no sequence.
Dpds truth() {
  Dpds model;
  model.visual = {Eigen::RowVector2d(3, -1), Eigen::RowVector2d(2, 0.5)};
  model.chain.phones = {"a", "b", "c"};
  model.first.resize(3, 2);
  model.first << 1, -1, -2, 1, 0, 0;
  model.prediction.resize(3, 2);
  model.prediction << 0.8, 0.6, 0.3, -0.4, 0.9, 0.7;
  model.offset.resize(3, 2);
  model.offset << 0.4, -0.6, -1, 1, 0.1, 0.5;
  model.noise = Eigen::RowVector2d(0.02, 0.05);
  model.chain.start = Eigen::Vector3d(0.5, 0.49, 0.01);
  model.chain.transitions.resize(3, 3);
  model.chain.transitions << 0.7, 0.2, 0.1, 0.2, 0.7, 0.1, 0.2, 0.2, 0.6;
  return model;
}

FrameLabels draw_labels(const Dpds& model, int length, Random& random) {
  const auto draw = [&](const Eigen::RowVectorXd& shares) {
    double left = random.uniform();
    Eigen::Index k = 0;
    while (k + 1 < shares.size() && left >= shares[k]) left -= shares[k++];
    return k;
  };
  FrameLabels labels;
  Eigen::Index state = random.uniform() < 0.5 ? 0 : 1;
  for (int t = 0; t < length; ++t) {
    if (t > 0) state = draw(model.chain.transitions.row(state));
    labels.labels.push_back(model.chain.phones[static_cast<std::size_t>(state)]);
  }
  return labels;
}

Track sound(Eigen::Index frames) {
  Track t;
  t.values.setZero(frames, 1);
  return t;
}

struct Corpus {
  Collected<Track> visual;
  Collected<FrameLabels> labels;
};

/// Sequences of the model, with its noise or without.
Corpus sample(const Dpds& model, int sequences, int length, bool noisy, std::uint64_t seed) {
  Random random(seed);
  Corpus corpus;
  for (int i = 0; i < sequences; ++i) {
    const FrameLabels labels = draw_labels(model, length, random);
    Track track = SynthesiseDpds{}(model, sound(length), labels);
    const Eigen::RowVectorXd deviation = model.noise.cwiseSqrt().cwiseProduct(model.visual.deviation);
    if (noisy)
      track.values += gaussian(length, 2, 1000 * seed + static_cast<std::uint64_t>(i)) * deviation.asDiagonal();
    corpus.labels.add(std::to_string(i), labels);
    corpus.visual.add(std::to_string(i), std::move(track));
  }
  return corpus;
}

const StateRuns& runs() {
  static const StateRuns r{{{0, 0, 1, 2, 2, 1}, {1, 0, 0, 2}, {2}, {0, 1}}, 4};
  return r;
}

TEST(DpdsObjective, GradientIsThatOfCentralDifferences) {
  const Eigen::VectorXd frames = gaussian(13, 1, 3);
  for (const double bound : {0.0, 0.9})
    for (const double floor : {1e-6, 10.0}) {
      DpdsObjective objective(runs(), frames, floor, bound);
      const GradientCheck check = check_gradient(objective, 0.5 * gaussian(4, 1, 9));
      EXPECT_TRUE(check.evaluated && check.cost_consistent);
      EXPECT_LT(check.worst, 1e-7) << check.report();
    }
}

TEST(DpdsObjective, OffsetsAreTheLikeliest) {
  const Eigen::VectorXd frames = gaussian(13, 1, 3), a = Eigen::Vector4d(0.5, -0.3, 0.9, 0.1);
  DpdsObjective objective(runs(), frames, 1e-9, 0);
  double cost = 0;
  ASSERT_TRUE(objective.evaluate(a, cost, nullptr));
  // Directly: each column of the design is the path with one unknown at 1.
  Eigen::MatrixXd design(13, 8);
  for (Eigen::Index u = 0; u < 8; ++u) {
    Eigen::Index row = 0;
    for (const auto& states : runs().sequences) {
      double x = u == states[0];
      design(row++, u) = x;
      for (std::size_t t = 1; t < states.size(); ++t) design(row++, u) = x = a[states[t]] * x + (u == 4 + states[t]);
    }
  }
  const Eigen::VectorXd best = design.completeOrthogonalDecomposition().solve(frames);
  EXPECT_TRUE(objective.first().isApprox(best.head(4), 1e-10));
  EXPECT_TRUE(objective.offset().isApprox(best.tail(4), 1e-10));
  const double variance = (design * best - frames).squaredNorm() / 13;
  EXPECT_NEAR(objective.noise(), variance, 1e-12);
  EXPECT_NEAR(cost, 6.5 * (std::log(2 * std::numbers::pi * variance) + 1), 1e-9);
  EXPECT_FALSE(objective.evaluate(1e200 * a, cost, nullptr));
}

/// The parts of a model that depend on its scaling, in the frames' own units.
struct OwnUnits {
  Eigen::MatrixXd first, offset;
  Eigen::RowVectorXd noise;
};
OwnUnits own_units(const Dpds& model) {
  const auto scaled_back = [&](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
    return m * model.visual.deviation.asDiagonal();
  };
  const Eigen::MatrixXd kept = 1 - model.prediction.array();
  return {scaled_back(model.first).rowwise() + model.visual.mean,
          scaled_back(model.offset) + kept * model.visual.mean.asDiagonal(),
          model.noise.cwiseProduct(model.visual.deviation.cwiseAbs2())};
}

TEST(Dpds, RecoversTheModelItsDataWereDrawnFrom) {
  Context context;
  for (const double bound : {0.0, 0.98}) {
    const Corpus corpus = sample(truth(), 40, 60, true, 1);
    TrainDpds train;
    train.bound = bound;
    const Dpds model = train(corpus.visual, corpus.labels, context);
    EXPECT_EQ(model.chain.phones, truth().chain.phones);
    EXPECT_LT((model.prediction - truth().prediction).cwiseAbs().maxCoeff(), 0.05);
    const OwnUnits found_parts = own_units(model), true_parts = own_units(truth());
    EXPECT_LT((found_parts.noise.array() / true_parts.noise.array() - 1).abs().maxCoeff(), 0.1);
    EXPECT_LT((found_parts.first - true_parts.first).topRows(2).cwiseAbs().maxCoeff(), 0.15) << "c begins nothing";
    EXPECT_LT((found_parts.offset - true_parts.offset).cwiseAbs().maxCoeff(), 0.15);
    EXPECT_NEAR(model.chain.start[0], 0.5, 0.15);
    EXPECT_LT((model.chain.transitions - truth().chain.transitions).cwiseAbs().maxCoeff(), 0.05);
    EXPECT_LT(testing::largest_fall(model.trace), 1e-12);
    EXPECT_GT(model.trace.size(), 3U);
    const Corpus unseen = sample(truth(), 10, 60, false, 2);
    for (std::size_t i = 0; i < 10; ++i) {
      const Track found = SynthesiseDpds{}(model, sound(60), unseen.labels[i]);
      EXPECT_LT((found.values - unseen.visual[i].values).cwiseAbs().maxCoeff(), 0.15);
    }
  }
}

/// ln p(frames, states) of all state sequences, one by one.
double best_score(const Dpds& model, const Eigen::MatrixXd& frames, std::vector<Eigen::Index>& best) {
  const auto length = static_cast<std::size_t>(frames.rows());
  double most = -std::numeric_limits<double>::infinity();
  std::vector<Eigen::Index> states(length);
  for (std::size_t code = 0; code < static_cast<std::size_t>(std::pow(3, length)); ++code) {
    std::size_t rest = code;
    for (auto& s : states) {
      s = static_cast<Eigen::Index>(rest % 3);
      rest /= 3;
    }
    double score = std::log(model.chain.start[states[0]]);
    Eigen::RowVectorXd x = model.first.row(states[0]);
    for (std::size_t t = 0; t < length; ++t) {
      if (t > 0) {
        score += std::log(model.chain.transitions(states[t - 1], states[t]));
        x = x.cwiseProduct(model.prediction.row(states[t])) + model.offset.row(states[t]);
      }
      const Eigen::RowVectorXd error = x - frames.row(static_cast<Eigen::Index>(t));
      score -= 0.5 * (error.cwiseAbs2().cwiseQuotient(model.noise).sum() +
                      (2 * std::numbers::pi * model.noise.array()).log().sum());
    }
    if (score <= most) continue;
    most = score;
    best = states;
  }
  return most;
}

TEST(DpdsDecode, FindsThePhonesThatASearchOfAllSequencesFinds) {
  Dpds model = truth();
  model.visual = {Eigen::RowVector2d::Zero(), Eigen::RowVector2d::Ones()};
  const Corpus corpus = sample(model, 10, 7, true, 4);
  int agree = 0, total = 0, right = 0;
  for (std::size_t i = 0; i < 10; ++i) {
    std::vector<Eigen::Index> best;
    best_score(model, corpus.visual[i].values, best);
    const FrameLabels found = DecodeDpds{}(model, corpus.visual[i]);
    for (std::size_t t = 0; t < 7; ++t, ++total) {
      agree += found.labels[t] == model.chain.phones[static_cast<std::size_t>(best[t])];
      right += found.labels[t] == corpus.labels[i].labels[t];
    }
  }
  EXPECT_GE(agree, 0.95 * total);
  EXPECT_GE(right, 0.9 * total);
}

TEST(DpdsDecode, BridgesLostFrames) {
  const Corpus corpus = sample(truth(), 1, 30, true, 4);
  Track face = corpus.visual[0];
  const FrameLabels whole = DecodeDpds{}(truth(), face);
  face.values.row(10).setConstant(1e9);
  face.lost = {10};
  const FrameLabels bridged = DecodeDpds{}(truth(), face);
  int same = 0;
  for (std::size_t t = 0; t < 30; ++t) same += whole.labels[t] == bridged.labels[t];
  EXPECT_GE(same, 28);
  face.values.resize(0, 2);
  face.lost.clear();
  EXPECT_TRUE(DecodeDpds{}(truth(), face).labels.empty());
  face.values = gaussian(3, 3, 1);
  EXPECT_THROW(DecodeDpds{}(truth(), face), std::runtime_error);
}

TEST(DpdsDecode, RefusesPathsThatOverflow) {
  Dpds model = truth();
  model.prediction.setConstant(3);
  Track face = sample(truth(), 1, 1000, true, 4).visual[0];
  EXPECT_THROW(DecodeDpds{}(model, face), std::runtime_error);
  // A phone that stays where it is has a path; the others do not take it along.
  model.prediction.row(0).setZero();
  EXPECT_EQ(DecodeDpds{}(model, face).labels.back(), model.chain.phones[0]);
}

TEST(DpdsSynthesise, AnUnknownPhoneLeavesTheFaceAsItIs) {
  Track audio = sound(4);
  audio.rate = Rational(30);
  audio.start = 0.5;
  const Track face = SynthesiseDpds{}(truth(), audio, {{"x", "a", "y", "b"}, 30});
  EXPECT_EQ(face.values.row(0), truth().visual.mean);
  EXPECT_TRUE(face.values.row(1).isApprox(Eigen::RowVector2d(3 + 2 * 0.4, -1 - 0.5 * 0.6)));
  EXPECT_EQ(face.values.row(2), face.values.row(1));
  EXPECT_EQ(face.rate, Rational(30));
  EXPECT_EQ(face.start, 0.5);
  EXPECT_EQ(SynthesiseDpds{}(truth(), sound(3), {{"a"}, 25}).frames(), 1);
  EXPECT_EQ(SynthesiseDpds{}(truth(), sound(0), {}).frames(), 0);
  EXPECT_THROW(SynthesiseDpds{}(truth(), sound(9), {{"a"}, 25}), std::runtime_error);
}

TEST(Dpds, LearnsNothingFromLostFramesAndRepeatsItsBits) {
  Context context;
  const Corpus corpus = sample(truth(), 6, 40, true, 1);
  Track face = corpus.visual[3];
  face.values.row(20).setConstant(1e9);
  face.lost = {20};
  Collected<Track> visual;
  for (std::size_t i = 0; i < 6; ++i) visual.add(std::to_string(i), i == 3 ? face : corpus.visual[i]);
  const Dpds model = TrainDpds{}(visual, corpus.labels, context);
  EXPECT_LT(model.visual.deviation.maxCoeff(), 100);
  EXPECT_EQ(model.offset, TrainDpds{}(visual, corpus.labels, context).offset);
}

TEST(Dpds, ALongPhoneComesToRest) {
  Context context;
  Corpus corpus;
  Track rise;
  rise.values = Eigen::MatrixXd::NullaryExpr(6, 1, [](Eigen::Index t, Eigen::Index) { return std::pow(1.7, t); });
  corpus.visual.add("a", rise);
  corpus.labels.add("a", {std::vector<std::string>(6, "a"), 25});
  const Dpds model = TrainDpds{}(corpus.visual, corpus.labels, context);
  const Track face = SynthesiseDpds{}(model, sound(3000), {std::vector<std::string>(3000, "a"), 25});
  EXPECT_TRUE(face.values.allFinite());
  EXPECT_TRUE(face.values.row(2999).isApprox(face.values.row(2990), 1e-3));
}

TEST(Dpds, AnswersDegenerateData) {
  Context context;
  const auto train = [&](const Eigen::MatrixXd& values, std::vector<std::string> labels) {
    Track t;
    t.values = values;
    const Dpds model = TrainDpds{}({{"x", t}}, {{"x", {labels, 25}}}, context);
    Track face = SynthesiseDpds{}(model, sound(t.frames()), {labels, 25});
    EXPECT_TRUE(face.values.allFinite());
    EXPECT_EQ(DecodeDpds{}(model, t).labels.size(), labels.size());
    return face;
  };
  EXPECT_TRUE(train(Eigen::RowVector2d(1, 2), {"a"}).values.isApprox(Eigen::RowVector2d(1, 2)));
  EXPECT_TRUE(train(Eigen::MatrixXd::Constant(5, 2, 0.3), {"a", "a", "b", "b", "c"}).values.isApproxToConstant(0.3));
  train(gaussian(4, 3, 1), {"a", "b", "c", "d"});
}

TEST(Dpds, RefusesWhatItCannotUse) {
  Context context;
  const Corpus corpus = sample(truth(), 1, 20, true, 1);
  EXPECT_THROW(TrainDpds{}(corpus.visual, {}, context), std::runtime_error);
  EXPECT_THROW(TrainDpds{}({}, corpus.labels, context), std::runtime_error);
  EXPECT_THROW(TrainDpds{}(corpus.visual, {{"0", {std::vector<std::string>(17, "a"), 25}}}, context),
               std::runtime_error);
  Track wrong = corpus.visual[0];
  wrong.values(3, 1) = NAN;
  EXPECT_THROW(TrainDpds{}({{"0", wrong}}, corpus.labels, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
