#include "nodes/face/mouth_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "graph/random.h"
#include "nodes/face/geometry.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

/// The average face, its mouth lowered by `down` and widened by a share of `wide`.
Shape face(double down, double wide = 0) {
  Shape shape = find_scheme("ibug68")->mean;
  for (int i = 48; i < 68; ++i) shape.row(i) += Eigen::RowVector2d(wide * shape(i, 0), down);
  return shape;
}

Pose any_pose(Random& random) {
  return {random.uniform(0.8, 1.2), random.uniform(-0.3, 0.3), random.uniform(50, 90), random.uniform(20, 60)};
}

/// A head that moves at random, whose mouth does what these say.
LandmarkTrack clip(const Eigen::VectorXd& down, const Eigen::VectorXd& wide, std::uint64_t seed) {
  Random random(seed);
  LandmarkTrack landmarks;
  for (Eigen::Index t = 0; t < down.size(); ++t)
    landmarks.frames.push_back(transform(any_pose(random), face(down[t], wide[t])));
  return landmarks;
}

const Eigen::VectorXd kDown = (Eigen::VectorXd(6) << 0, 4, -3, 8, 1, 2).finished();
const Eigen::VectorXd kStill = Eigen::VectorXd::Zero(6);

TEST(MouthSpace, MeasuresTheMouthFreeOfHeadPose) {
  const auto landmarks = clip(kDown, kStill, 1);
  const auto space = LearnMouthSpace{}({{"a", landmarks}});
  ASSERT_EQ(space.modes.cols(), 1);
  const auto track = MeasureMouth{}(space, landmarks);
  ASSERT_EQ(track.values.rows(), 6);
  EXPECT_DOUBLE_EQ(track.start, 0.02);
  // 20 points move by as much, at the size of the mean.
  const Shape still = face(0).middleRows(27, 21);
  const double size = align(still, space.mean).scale * std::sqrt(20.0);
  const Eigen::VectorXd expected = size * (kDown.array() - kDown.mean());
  const double sign = track.values(3, 0) > 0 ? 1 : -1;
  EXPECT_LT((sign * track.values.col(0) - expected).norm(), 1e-9 * expected.norm());
}

TEST(MouthSpace, KeepsTheShareOfVarianceWanted) {
  const Eigen::VectorXd wide = (Eigen::VectorXd(6) << 0.02, -0.02, 0, 0, 0.02, -0.02).finished();
  const Collected<LandmarkTrack> training{{"a", clip(kDown, wide, 2)}};
  EXPECT_EQ(LearnMouthSpace{.retain = 0.9}(training).modes.cols(), 1);
  EXPECT_EQ(LearnMouthSpace{.retain = 0.99999}(training).modes.cols(), 2);
}

TEST(MouthSpace, TakesEachClipsMeanOff) {
  const Eigen::VectorXd lower = kDown.array() + 20;
  const Collected<LandmarkTrack> training{{"a", clip(kDown, kStill, 3)}, {"b", clip(lower, kStill, 4)}};
  const auto space = LearnMouthSpace{}(training);
  const auto a = MeasureMouth{}(space, training[0]), b = MeasureMouth{}(space, training[1]);
  EXPECT_LT((a.values - b.values).norm(), 1e-9 * a.values.norm());
}

TEST(MouthSpace, FramesWithoutLandmarksAreLost) {
  auto landmarks = clip(kDown, kStill, 5);
  const Collected<LandmarkTrack> training{{"a", landmarks}};
  const auto space = LearnMouthSpace{}(training);
  landmarks.frames[1].setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto track = MeasureMouth{}(space, landmarks);
  EXPECT_EQ(track.lost, std::vector<std::int64_t>{1});
  EXPECT_EQ(track.values(1, 0), 0);
  EXPECT_NEAR(track.values.sum(), 0, 1e-9);
  EXPECT_EQ(LearnMouthSpace{}({{"a", landmarks}}).modes.cols(), 1);
}

TEST(MouthSpace, SaysWhatIsWrong) {
  EXPECT_THROW(LearnMouthSpace{}({}), std::runtime_error);
  EXPECT_THROW(LearnMouthSpace{}({{"a", LandmarkTrack{}}}), std::runtime_error);
  EXPECT_THROW(LearnMouthSpace{}({{"a", clip(kStill, kStill, 6)}}), std::runtime_error);
  EXPECT_THROW(LearnMouthSpace{.mouth = {"beard"}}({{"a", clip(kDown, kStill, 6)}}), std::runtime_error);
  const auto space = LearnMouthSpace{}({{"a", clip(kDown, kStill, 6)}});
  EXPECT_THROW(MeasureMouth{}(space, LandmarkTrack{}), std::runtime_error);
  auto other = space;
  other.mean.conservativeResize(5, 2);
  EXPECT_THROW(MeasureMouth{}(other, clip(kDown, kStill, 6)), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
