#include "nodes/latent/trajectory.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::positive;

TEST(WithChanges, AreDifferencesWithinEachSequence) {
  Eigen::MatrixXd frames(5, 1);
  frames << 1, 4, 9, 2, 7;
  Eigen::MatrixXd expected(5, 3);
  expected << 1, 0, 3, 4, 3, 2, 9, 5, -5, 2, 0, 5, 7, 5, -5;
  EXPECT_EQ(with_changes({frames, {3, 2}}, 2), expected);
  EXPECT_EQ(with_changes({frames, {3, 2}}, 1), expected.leftCols(2));
  EXPECT_EQ(with_changes({frames.topRows(1), {1}}, 2), Eigen::RowVector3d(1, 0, 0));

  const Eigen::MatrixXd wide = gaussian(6, 2, 1);
  const Eigen::MatrixXd all = with_changes({wide, {6}}, 1);
  EXPECT_EQ(all.leftCols(2), wide);
  EXPECT_EQ(all.col(3), with_changes({wide.col(1), {6}}, 1).col(1));
}

TrajectoryStates random_states(Eigen::Index dims, int order, bool full) {
  TrajectoryStates states{gaussian(3, dims * (1 + order), 5), {}, order};
  for (std::uint64_t k = 0; k < 3; ++k) {
    const Eigen::MatrixXd covariance = positive(dims * (1 + order), k);
    states.covariances.push_back(full ? covariance : Eigen::MatrixXd(covariance.diagonal()));
  }
  return states;
}

/// By dense least squares: with_changes is linear, so that its columns are what it makes of unit frames.
Eigen::MatrixXd dense(const TrajectoryStates& states, const std::vector<Eigen::Index>& path) {
  const Eigen::Index changes = states.means.cols(), dims = changes / (1 + states.order), frames = std::ssize(path);
  Eigen::MatrixXd windows(frames * changes, frames * dims);
  for (Eigen::Index i = 0; i < windows.cols(); ++i) {
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(frames, dims);
    unit(i / dims, i % dims) = 1;
    windows.col(i) = with_changes({unit, {frames}}, states.order).transpose().reshaped();
  }
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(windows.rows(), windows.rows());
  Eigen::VectorXd means(windows.rows());
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto state = static_cast<std::size_t>(path[static_cast<std::size_t>(t)]);
    const Eigen::MatrixXd& c = states.covariances[state];
    precision.block(t * changes, t * changes, changes, changes) =
        (c.cols() == 1 ? Eigen::MatrixXd(c.asDiagonal()) : c).inverse();
    means.segment(t * changes, changes) = states.means.row(static_cast<Eigen::Index>(state));
  }
  const Eigen::VectorXd solution =
      (windows.transpose() * precision * windows).partialPivLu().solve(windows.transpose() * precision * means);
  return solution.reshaped(dims, frames).transpose();
}

TEST(LikeliestTrajectory, IsTheSolutionOfLeastSquares) {
  for (const bool full : {true, false})
    for (const int order : {1, 2})
      for (const auto& path : {std::vector<Eigen::Index>{1}, {0, 2}, {2, 2, 0}, {0, 0, 0, 1, 1, 2, 0, 1, 1, 1, 2, 2}}) {
        const TrajectoryStates states = random_states(3, order, full);
        const Eigen::MatrixXd expected = dense(states, path);
        EXPECT_LT((likeliest_trajectory(states, path) - expected).norm(), 1e-9 * (1 + expected.norm()));
      }
  EXPECT_EQ(likeliest_trajectory(random_states(3, 1, true), {}).rows(), 0);
  EXPECT_EQ(likeliest_trajectory(random_states(3, 1, true), {}).cols(), 3);
}

TEST(LikeliestTrajectory, MovesSmoothlyBetweenStates) {
  TrajectoryStates states{Eigen::MatrixXd(2, 2), {Eigen::Vector2d(1, 0.01), Eigen::Vector2d(1, 0.01)}, 1};
  states.means << 0, 0, 1, 0;
  const Eigen::VectorXd z = likeliest_trajectory(states, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1});
  for (Eigen::Index t = 1; t < z.size(); ++t) {
    EXPECT_GE(z(t) - z(t - 1), -1e-3) << t;
    EXPECT_LT(z(t) - z(t - 1), 0.3) << t;
  }
}

TEST(LikeliestTrajectory, RefusesACovarianceThatIsNotPositive) {
  TrajectoryStates states = random_states(2, 1, false);
  states.covariances[1](0) = 0;
  EXPECT_THROW(likeliest_trajectory(states, {0, 1}), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
