#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "nodes/yardstick/mean.h"
#include "nodes/yardstick/neighbours.h"
#include "nodes/yardstick/ridge.h"
#include "nodes/yardstick/stacked.h"
#include "nodes/yardstick/trajectories.h"

namespace talkgraph {
namespace {

Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  return t;
}

TEST(Mean, PredictsTheTrainingMean) {
  const auto model = MeanTrain{}({{"a", track(Eigen::Vector2d(1, 3))}, {"b", track(Eigen::Matrix<double, 1, 1>(8))}});
  const Track p = MeanPredict{}(model, track(Eigen::MatrixXd::Zero(5, 2)));
  EXPECT_EQ(p.values, Eigen::MatrixXd::Constant(5, 1, 4));
  EXPECT_THROW(MeanTrain{}({}), std::runtime_error);
}

TEST(Ridge, SolvesThePenalisedNormalEquations) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(40, 3), v = Eigen::MatrixXd::Random(40, 2);
  const auto model = RidgeTrain{.context = 0, .lambda = 0.3}({{"x", track(a)}}, {{"x", track(v)}});
  // Directly: the offset as a further, unpenalised column.
  const Eigen::RowVectorXd mean = a.colwise().mean();
  Eigen::MatrixXd z = a.rowwise() - mean;
  for (int d = 0; d < 3; ++d) z.col(d) /= std::sqrt(z.col(d).squaredNorm() / 40);
  Eigen::MatrixXd design(40, 4);
  design << z, Eigen::VectorXd::Ones(40);
  Eigen::MatrixXd normal = design.transpose() * design;
  normal.topLeftCorner(3, 3).diagonal().array() += 0.3 * 40;
  const Eigen::MatrixXd w = normal.inverse() * design.transpose() * v;
  EXPECT_TRUE(RidgePredict{}(model, track(a)).values.isApprox(design * w, 1e-10));
}

TEST(Ridge, SurvivesConstantColumnsAndOneFrame) {
  const auto model =
      RidgeTrain{}({{"x", track(Eigen::MatrixXd::Ones(1, 3))}}, {{"x", track(Eigen::MatrixXd::Constant(1, 2, 7))}});
  const Track p = RidgePredict{}(model, track(Eigen::MatrixXd::Random(4, 3)));
  EXPECT_TRUE(p.values.isApprox(Eigen::MatrixXd::Constant(4, 2, 7)));
  EXPECT_THROW(RidgePredict{}(model, track(Eigen::MatrixXd::Random(4, 2))), std::runtime_error);
  EXPECT_THROW(RidgeTrain{}({}, {}), std::runtime_error);
  EXPECT_THROW(RidgeTrain{}({{"x", track(Eigen::MatrixXd::Ones(9, 1))}}, {{"x", track(Eigen::MatrixXd::Ones(5, 1))}}),
               std::runtime_error);
}

TEST(Neighbours, AgreesWithASearchFrameByFrame) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(60, 2), v = Eigen::MatrixXd::Random(60, 3),
                        q = Eigen::MatrixXd::Random(9, 2);
  const Eigen::RowVectorXd mean = a.colwise().mean();
  const auto z = [&](const Eigen::MatrixXd& m, Eigen::Index t, int d) {
    const double deviation = std::sqrt((a.col(d).array() - mean[d]).square().mean());
    return (m(std::clamp<Eigen::Index>(t, 0, m.rows() - 1), d) - mean[d]) / deviation;
  };
  for (const double width : {0.0, 0.8}) {
    const auto model = NeighboursTrain{1, width}({{"x", track(a)}}, {{"x", track(v)}});
    const Track p = NeighboursPredict{3}(model, track(q));
    const double beside = width > 0 ? std::exp(-1 / (width * width)) : 1;
    for (Eigen::Index t = 0; t < 9; ++t) {
      std::vector<std::pair<double, Eigen::Index>> order;
      for (Eigen::Index s = 0; s < 60; ++s) {
        double sum = 0;
        for (int i = -1; i <= 1; ++i)
          for (int d = 0; d < 2; ++d) sum += (i == 0 ? 1 : beside) * std::pow(z(q, t + i, d) - z(a, s + i, d), 2);
        order.emplace_back(sum, s);
      }
      std::sort(order.begin(), order.end());
      const Eigen::RowVectorXd expected =
          (v.row(order[0].second) + v.row(order[1].second) + v.row(order[2].second)) / 3;
      EXPECT_TRUE(p.values.row(t).isApprox(expected, 1e-12)) << width;
    }
  }
}

TEST(Neighbours, TakesAllWhereThereAreFewerThanK) {
  const auto model = NeighboursTrain{0}({{"x", track(Eigen::Vector2d(0, 1))}}, {{"x", track(Eigen::Vector2d(2, 4))}});
  EXPECT_EQ(NeighboursPredict{10}(model, track(Eigen::Matrix<double, 1, 1>(0))).values(0, 0), 3);
}

TEST(Neighbours, FindsATrainingFrameItself) {
  const Track a = track(Eigen::MatrixXd::Random(50, 4)), v = track(Eigen::MatrixXd::Random(50, 2));
  const auto model = NeighboursTrain{}({{"x", a}}, {{"x", v}});
  EXPECT_TRUE(NeighboursPredict{1}(model, a).values.isApprox(v.values));
}

TEST(Neighbours, ComparesDimensionsAsTheyAreWithoutScale) {
  Eigen::MatrixXd a(3, 2), q(1, 2);
  a << 0, 0, 100, 0, 0, 3;
  q << 40, 2;
  const Track v = track(Eigen::Vector3d(1, 2, 3));
  const auto nearest = [&](bool scale) {
    const auto model = NeighboursTrain{.context = 0, .scale = scale}({{"x", track(a)}}, {{"x", v}});
    return NeighboursPredict{1}(model, track(q)).values(0, 0);
  };
  EXPECT_EQ(nearest(true), 3);
  EXPECT_EQ(nearest(false), 3);
  q << 51, 2;
  EXPECT_EQ(nearest(true), 3);
  EXPECT_EQ(nearest(false), 2);
}

StateData state(std::string label, std::vector<Eigen::MatrixXd> windows) {
  return {std::move(label), windows, windows};
}

TrajectoriesModel trained(const std::vector<StateData>& states) {
  Collected<StateData> all;
  for (const auto& s : states) all.add(s.label, s);
  return TrajectoriesTrain{}(all);
}

TEST(Trajectories, AreMeansOfStretchedWindows) {
  const auto model = trained({state("k-ae", {Eigen::Vector3d(0, 3, 6), Eigen::Vector3d(2, 5, 14)}),
                              state("ae", {Eigen::Vector4d(0, 1, 2, 3), Eigen::Vector2d(10, 20)})});
  EXPECT_EQ(model.trajectories.at("k-ae"), Eigen::Vector3d(1, 4, 10));
  // Three frames out of four and of two.
  const Eigen::Vector3d four(1.0 / 6, 1.5, 17.0 / 6), two(10, 15, 20);
  EXPECT_TRUE(model.trajectories.at("ae").isApprox((four + two) / 2, 1e-12));
  EXPECT_NEAR(model.mean(0), 66.0 / 12, 1e-12);
  SegmentTrack segments{{{"k-ae", 0, 3}, {"k-ae", 3, 1}}, 4, Rational{50}};
  const Track p = TrajectoriesPredict{}(model, segments);
  EXPECT_EQ(p.values, Eigen::Vector4d(1, 4, 10, 4));
  EXPECT_EQ(p.rate.value(), 50);
  EXPECT_EQ(p.start, 0.01);
}

TEST(Trajectories, AnswerEveryLabel) {
  const auto level = [](double value, Eigen::Index frames) {
    return std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Constant(frames, 1, value)};
  };
  const auto model =
      trained({state("t-ae", level(1, 2)), state("b-iy", level(2, 2)), state("k-iy", level(3, 5)), state("empty", {})});
  const auto answer = [&](const std::string& label) {
    return TrajectoriesPredict{}(model, {{{label, 0, 1}}, 1}).values(0, 0);
  };
  EXPECT_EQ(answer("t-ae"), 1);
  EXPECT_EQ(answer("s-t-ae"), 1);
  EXPECT_EQ(answer("s-iy"), 3);
  EXPECT_NEAR(answer("zh"), (2 + 4 + 15) / 9.0, 1e-12);
  EXPECT_EQ(answer("empty"), answer("zh"));
  EXPECT_EQ(TrajectoriesPredict{}(model, {}).frames(), 0);
}

TEST(Trajectories, RefuseWhatIsNoTrainingAndGaps) {
  EXPECT_THROW(trained({}), std::runtime_error);
  EXPECT_THROW(trained({state("a", {})}), std::runtime_error);
  EXPECT_THROW(trained({state("a", {Eigen::MatrixXd::Constant(2, 1, NAN)})}), std::runtime_error);
  EXPECT_THROW(trained({state("a", {Eigen::MatrixXd::Zero(2, 1), Eigen::MatrixXd::Zero(2, 2)})}), std::runtime_error);
  const auto model = trained({state("a", {Eigen::MatrixXd::Zero(2, 1)})});
  EXPECT_THROW(TrajectoriesPredict{}(model, {{{"a", 1, 1}}, 2}), std::runtime_error);
  EXPECT_THROW(TrajectoriesPredict{}(model, {{{"a", 0, 1}}, 2}), std::runtime_error);
  EXPECT_THROW(TrajectoriesPredict{}(model, {{{"a", 0, 3}}, 2}), std::runtime_error);
  EXPECT_THROW(TrajectoriesPredict{}(model, {{{"a", 0, 0}}, 0}), std::runtime_error);
}

TEST(Yardsticks, PairByKeyAndUseTheCommonBeginning) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(20, 2), v = Eigen::MatrixXd::Random(18, 1);
  const auto model = NeighboursTrain{0}({{"no pair", track(a)}, {"x", track(a)}},
                                        {{"x", track(v)}, {"neither", track(Eigen::MatrixXd::Zero(3, 1))}});
  EXPECT_EQ(model.audio.rows(), 18);
  EXPECT_EQ(model.visual, v);
}

TEST(Yardsticks, LearnNothingFromLostFrames) {
  Track audio, visual;
  audio.values = Eigen::VectorXd::LinSpaced(4, 0, 3);
  visual.values = Eigen::Vector4d(1, 3, 1000, 5);
  visual.lost = {2};
  EXPECT_EQ(MeanTrain{}({{"u", visual}}).mean(0), 3);
  const auto training = stack_training({{"u", audio}}, {{"u", visual}}, 0);
  EXPECT_EQ(training.visual, Eigen::Vector3d(1, 3, 5));
  visual.lost = {0, 1, 2, 3};
  EXPECT_THROW(stack_training({{"u", audio}}, {{"u", visual}}, 0), std::runtime_error);
  EXPECT_THROW(MeanTrain{}({{"u", visual}}), std::runtime_error);
}

TEST(Yardsticks, RefuseNanAndOtherDimensions) {
  Eigen::MatrixXd broken = Eigen::MatrixXd::Random(9, 2);
  const Track good = track(broken), other = track(Eigen::MatrixXd::Random(9, 3));
  broken(4, 1) = NAN;
  const Track bad = track(broken);
  EXPECT_THROW(MeanTrain{}({{"a", bad}}), std::runtime_error);
  EXPECT_THROW(MeanTrain{}({{"a", good}, {"b", other}}), std::runtime_error);
  EXPECT_THROW(RidgeTrain{}({{"a", bad}}, {{"a", good}}), std::runtime_error);
  EXPECT_THROW(RidgeTrain{}({{"a", good}}, {{"a", bad}}), std::runtime_error);
  EXPECT_THROW(RidgeTrain{}({{"a", good}, {"b", other}}, {{"a", good}, {"b", good}}), std::runtime_error);
  EXPECT_THROW(RidgeTrain{}({{"a", good}, {"b", good}}, {{"a", good}, {"b", other}}), std::runtime_error);
  const auto neighbours = NeighboursTrain{}({{"a", good}}, {{"a", good}});
  EXPECT_THROW(NeighboursPredict{}(neighbours, bad), std::runtime_error);
  const auto ridge = RidgeTrain{}({{"a", good}}, {{"a", good}});
  EXPECT_THROW(RidgePredict{}(ridge, bad), std::runtime_error);
  EXPECT_EQ(RidgePredict{}(ridge, track(Eigen::MatrixXd(0, 2))).frames(), 0);
  EXPECT_EQ(NeighboursPredict{}(neighbours, track(Eigen::MatrixXd(0, 2))).frames(), 0);
}

}  // namespace
}  // namespace talkgraph
