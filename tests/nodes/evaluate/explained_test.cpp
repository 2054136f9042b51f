#include "nodes/evaluate/explained.h"

#include <gtest/gtest.h>

#include <cmath>

#include "graph/random.h"

namespace talkgraph {
namespace {

Track track(Eigen::MatrixXd values, std::vector<std::string> names = {}) {
  return {std::move(values), Rational(25), 0, std::move(names)};
}

Eigen::MatrixXd noise(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd out(rows, columns);
  for (double& v : out.reshaped()) v = random.normal();
  return out;
}

TEST(Explained, GivesTheShareThatIsLinear) {
  const Eigen::MatrixXd by = noise(4000, 3, 1), other = noise(4000, 1, 2);
  Eigen::MatrixXd truth(4000, 4);
  truth << by.col(0) - 2 * by.col(2) + Eigen::VectorXd::Constant(4000, 9), by.col(1) + other, other,
      Eigen::VectorXd::Constant(4000, 3);
  const auto table = Explained{}({{"a", track(truth, {"all", "half", "none", "still"})}}, {{"a", track(by)}});
  EXPECT_EQ(table.columns, (std::vector<std::string>{"all", "half", "none", "still"}));
  EXPECT_NEAR(table.cells[0][0], 1, 1e-9);
  EXPECT_NEAR(table.cells[0][1], 0.5, 0.05);
  EXPECT_NEAR(table.cells[0][2], 0, 0.01);
  EXPECT_TRUE(std::isnan(table.cells[0][3]));
}

TEST(Explained, LearnsNothingFromTheFramesItPredicts) {
  const auto share = explained_share(noise(60, 1, 3), noise(60, 30, 4), 5, 1e-9);
  EXPECT_EQ(share(0), 0) << "30 random dimensions fit 60 frames well, and say nothing of others";
}

TEST(Explained, APenaltyHoldsManyDimensions) {
  const Eigen::MatrixXd by = noise(200, 60, 8), truth = by.col(3) + 2 * noise(200, 1, 9);
  EXPECT_GT(explained_share(truth, by, 5, 1)(0), explained_share(truth, by, 5, 1e-9)(0));
  EXPECT_EQ(explained_share(truth, Eigen::MatrixXd::Zero(200, 3), 5, 1e-9)(0), 0);
}

TEST(Explained, TakesRoundingForNothing) {
  const Eigen::MatrixXd truth = noise(300, 1, 6);
  Eigen::MatrixXd by(300, 2);
  by << noise(300, 1, 7), 1e-12 * truth;
  EXPECT_NEAR(explained_share(truth, by, 5, 1e-9)(0), 0, 0.02);
}

TEST(Explained, MatchesClipsByKeyAndPassesOverLostFrames) {
  Eigen::MatrixXd by = noise(50, 1, 5), truth = 3 * by;
  truth(7, 0) = 1e9;
  by(20, 0) = -1e9;
  Track lost_truth = track(truth), lost_by = track(by);
  lost_truth.lost = {7};
  lost_by.lost = {20};
  const Collected<Track> a{{"x", track(noise(9, 1, 1))}, {"b", lost_truth}},
      b{{"y", track(noise(9, 1, 1))}, {"b", lost_by}};
  EXPECT_NEAR(Explained{}(a, b).cells[0][0], 1, 1e-9);
}

TEST(Explained, SaysWhatDoesNotFit) {
  const Track five = track(noise(5, 1, 1)), nine = track(noise(9, 1, 1)), wide = track(noise(9, 2, 1));
  EXPECT_THROW(Explained{}({}, {}), std::runtime_error);
  EXPECT_THROW(Explained{}({{"a", nine}}, {{"b", nine}}), std::runtime_error);
  EXPECT_THROW(Explained{}({{"a", five}}, {{"a", nine}}), std::runtime_error);
  EXPECT_THROW(Explained{}({{"a", nine}, {"b", wide}}, {{"a", nine}, {"b", nine}}), std::runtime_error);
  EXPECT_THROW(Explained{}({{"a", nine}}, {{"a", track(noise(9, 8, 1))}}), std::runtime_error);
  EXPECT_THROW(Explained{}({{"a", nine}}, {{"a", track(Eigen::MatrixXd::Constant(9, 1, NAN))}}), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
