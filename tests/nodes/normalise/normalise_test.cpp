#include <gtest/gtest.h>

#include "nodes/normalise/mean_center.h"
#include "nodes/normalise/mean_of.h"
#include "nodes/normalise/restore.h"

namespace talkgraph {
namespace {

Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  return t;
}

TEST(MeanCenter, TakesTheMeanOffAndRestorePutsItBack) {
  const Track t = track(Eigen::MatrixXd::Random(7, 3));
  const auto out = MeanCenter{}(t, nullptr);
  EXPECT_LT(out.centred.values.colwise().mean().cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_TRUE(Restore{}(out.centred, out.mean).values.isApprox(t.values, 1e-14));
}

TEST(MeanCenter, CountsOnlyUsableFrames) {
  const Track t = track(Eigen::Vector3d(1, 3, 100));
  const Mask usable{{1, 1, 0}};
  EXPECT_EQ(MeanCenter{}(t, &usable).mean.values(0, 0), 2);
  EXPECT_EQ(MeanCenter{}(t, &usable).centred.values(2, 0), 98);
  const Mask none{{0, 0, 0}};
  EXPECT_THROW(MeanCenter{}(t, &none), std::runtime_error);
  EXPECT_THROW(MeanCenter{}(Track{}, nullptr), std::runtime_error);
}

TEST(Restore, RefusesAMeanThatDoesNotFit) {
  EXPECT_THROW(Restore{}(track(Eigen::MatrixXd::Zero(2, 3)), track(Eigen::MatrixXd::Zero(1, 2))), std::runtime_error);
  EXPECT_THROW(Restore{}(track(Eigen::MatrixXd::Zero(2, 3)), track(Eigen::MatrixXd::Zero(2, 3))), std::runtime_error);
}

TEST(MeanOf, WeighsRowsAlike) {
  const Collected<Track> all{{"a", track(Eigen::Vector2d(1, 2))}, {"b", track(Eigen::MatrixXd::Constant(1, 1, 6))}};
  EXPECT_EQ(MeanOf{}(all).values(0, 0), 3);
  EXPECT_THROW(MeanOf{}({}), std::runtime_error);
  EXPECT_THROW(MeanOf{}({{"a", track(Eigen::MatrixXd::Zero(1, 1))}, {"b", track(Eigen::MatrixXd::Zero(1, 2))}}),
               std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
