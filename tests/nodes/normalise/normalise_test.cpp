#include <gtest/gtest.h>

#include "nodes/normalise/mean_center.h"
#include "nodes/normalise/mean_of.h"
#include "nodes/normalise/restore.h"
#include "nodes/normalise/zscore.h"

namespace talkgraph {
namespace {

Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  return t;
}

TEST(MeanCenter, TakesTheMeanOffAndRestorePutsItBack) {
  const Track t = track(Eigen::MatrixXd::Random(7, 3));
  const auto out = MeanCenter{}(t);
  EXPECT_LT(out.centred.values.colwise().mean().cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_TRUE(Restore{}(out.centred, out.mean).values.isApprox(t.values, 1e-14));
}

TEST(MeanCenter, LeavesLostFramesOutOfTheMean) {
  Track t = track(Eigen::Vector3d(1, 3, 100));
  t.lost = {2};
  const auto out = MeanCenter{}(t);
  EXPECT_EQ(out.mean.values(0, 0), 2);
  EXPECT_EQ(out.centred.values(2, 0), 98);
  EXPECT_EQ(out.centred.lost, t.lost);
  EXPECT_TRUE(out.mean.lost.empty());
  t.lost = {0, 1, 2};
  EXPECT_THROW(MeanCenter{}(t), std::runtime_error);
}

TEST(MeanCenter, RefusesNanAndNoFrames) {
  EXPECT_THROW(MeanCenter{}(Track{}), std::runtime_error);
  EXPECT_THROW(MeanCenter{}(track(Eigen::Vector2d(1, NAN))), std::runtime_error);
}

TEST(Restore, PutsBackARowAFrame) {
  const Track t = track(Eigen::MatrixXd::Random(4, 2)), offset = track(Eigen::MatrixXd::Random(4, 2));
  EXPECT_EQ(Restore{}(t, offset).values, t.values + offset.values);
  const Track shorter = track(offset.values.topRows(3));
  EXPECT_EQ(Restore{}(t, shorter).values.row(3), t.values.row(3) + offset.values.row(2));
}

TEST(Restore, RefusesAMeanThatDoesNotFit) {
  EXPECT_THROW(Restore{}(track(Eigen::MatrixXd::Zero(2, 3)), track(Eigen::MatrixXd::Zero(1, 2))), std::runtime_error);
  EXPECT_THROW(Restore{}(track(Eigen::MatrixXd::Zero(2, 3)), track(Eigen::MatrixXd::Zero(0, 3))), std::runtime_error);
  EXPECT_THROW(Restore{}(track(Eigen::MatrixXd::Zero(5, 3)), track(Eigen::MatrixXd::Zero(2, 3))), std::runtime_error);
}

TEST(MeanOf, WeighsRowsAlike) {
  const Collected<Track> all{{"a", track(Eigen::Vector2d(1, 2))}, {"b", track(Eigen::MatrixXd::Constant(1, 1, 6))}};
  EXPECT_EQ(MeanOf{}(all).values(0, 0), 3);
  EXPECT_THROW(MeanOf{}({}), std::runtime_error);
  EXPECT_THROW(MeanOf{}({{"a", track(Eigen::MatrixXd::Zero(1, 1))}, {"b", track(Eigen::MatrixXd::Zero(1, 2))}}),
               std::runtime_error);
}

TEST(Zscore, BringsTheTrainingRowsToMeanZeroAndDeviationOne) {
  Eigen::MatrixXd rows = 3 * Eigen::MatrixXd::Random(9, 3);
  rows.col(1).array() += 1e6;
  const Collected<Track> all{{"a", track(rows.topRows(4))}, {"b", track(rows.bottomRows(5))}};
  const Track statistics = ZscoreLearn{}(all);
  EXPECT_TRUE(statistics.values.row(0).isApprox(rows.colwise().mean(), 1e-14));
  const Eigen::MatrixXd z = ZscoreApply{}(track(rows), statistics).values;
  EXPECT_LT(z.colwise().mean().cwiseAbs().maxCoeff(), 1e-9);
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(z.col(d).squaredNorm() / 9, 1, 1e-9);
}

TEST(Zscore, GivesZeroWhereTrainingDoesNotVary) {
  const Track constant = track(Eigen::MatrixXd::Constant(1000, 1, 1e6 + 0.1));
  const Track statistics = ZscoreLearn{}({{"a", constant}});
  EXPECT_EQ(statistics.values(1, 0), 0);
  EXPECT_TRUE(ZscoreApply{}(track(Eigen::MatrixXd::Random(3, 1)), statistics).values.isZero());
}

TEST(Zscore, LearnsNothingFromLostFrames) {
  Track t = track(Eigen::Vector3d(1, 3, 100));
  t.lost = {2};
  EXPECT_EQ(ZscoreLearn{}({{"a", t}}).values, Eigen::Vector2d(2, 1));
  EXPECT_EQ(MeanOf{}({{"a", t}}).values(0, 0), 2);
  t.lost = {0, 1, 2};
  EXPECT_THROW(MeanOf{}({{"a", t}}), std::runtime_error);
}

TEST(Zscore, RefusesWhatDoesNotFit) {
  EXPECT_THROW(ZscoreLearn{}({}), std::runtime_error);
  const Track t = track(Eigen::MatrixXd::Zero(2, 3));
  EXPECT_THROW(ZscoreApply{}(t, track(Eigen::MatrixXd::Zero(2, 2))), std::runtime_error);
  EXPECT_THROW(ZscoreApply{}(t, track(Eigen::MatrixXd::Zero(1, 3))), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
