#include "nodes/mapping/trajectory_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "nodes/latent/cholesky.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

std::vector<TrajectoryRows> kinds_of_rows(Eigen::Index frames) {
  return {frames_and_slopes(frames), frames_and_differences(frames, 1), frames_and_differences(frames, 4),
          frames_slopes_and_curvatures(frames)};
}

TEST(TrajectoryFit, SolvesTheNormalEquations) {
  for (const Eigen::Index frames : {1, 2, 5, 30})
    for (const TrajectoryRows& rows : kinds_of_rows(frames)) {
      const Eigen::VectorXd precisions = gaussian(rows.rows(), 1, 1).cwiseAbs2(), targets = gaussian(rows.rows(), 1, 2);
      const Eigen::MatrixXd w = rows, matrix = w.transpose() * precisions.asDiagonal() * w;
      const Eigen::VectorXd expected = matrix.fullPivLu().solve(w.transpose() * precisions.cwiseProduct(targets));
      EXPECT_TRUE(TrajectoryFit(rows, precisions, targets).trajectory().isApprox(expected, 1e-9));
    }
}

TEST(TrajectoryFit, GradientIsThatOfCentralDifferences) {
  for (const TrajectoryRows& rows : kinds_of_rows(12)) {
    const Eigen::VectorXd precisions = gaussian(rows.rows(), 1, 1).array().square() + 0.1,
                          targets = gaussian(rows.rows(), 1, 2), weights = gaussian(12, 1, 3);
    const auto cost = [&](const Eigen::VectorXd& p, const Eigen::VectorXd& e) {
      return weights.dot(TrajectoryFit(rows, p, e).trajectory());
    };
    const auto by = TrajectoryFit(rows, precisions, targets).gradient(weights);
    for (Eigen::Index r = 0; r < rows.rows(); ++r) {
      const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Unit(rows.rows(), r);
      EXPECT_NEAR(by.precisions(r), (cost(precisions + step, targets) - cost(precisions - step, targets)) / 2e-5, 1e-7);
      EXPECT_NEAR(by.targets(r), (cost(precisions, targets + step) - cost(precisions, targets - step)) / 2e-5, 1e-7);
    }
  }
}

TEST(TrajectoryFit, RowsAreSlopesAndDifferences) {
  const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(7, 0, 6).array().square();
  const Eigen::VectorXd slopes = (frames_and_slopes(7) * y).tail(7), expected{{0.5, 2, 4, 6, 8, 10, 5.5}};
  EXPECT_EQ(slopes, expected);
  const Eigen::VectorXd curved = frames_slopes_and_curvatures(7) * y, curvatures{{1, 2, 2, 2, 2, 2, -11}};
  EXPECT_EQ(curved.segment(7, 7), expected);
  EXPECT_EQ(curved.tail(7), curvatures);
  EXPECT_EQ((frames_and_differences(7, 2) * y).tail(5), Eigen::VectorXd::Constant(5, 2));
  EXPECT_TRUE((frames_and_differences(7, 3) * y).tail(4).isZero());
  EXPECT_EQ(frames_and_differences(3, 3).rows(), 3);
}

TEST(TrajectoryFit, PutsBlocksOfRowsBesideEachOther) {
  const Eigen::MatrixXd y = gaussian(5, 2, 1);
  Eigen::MatrixXd expected(5, 4);
  expected.leftCols(2) = y;
  expected.topRightCorner(3, 2) = (frames_and_slopes(3) * y.topRows(3)).bottomRows(3);
  expected.bottomRightCorner(2, 2).rowwise() = 0.5 * (y.row(4) - y.row(3));
  EXPECT_EQ(blocks_beside(frames_and_slopes, 2, y, {3, 2}), expected);
  EXPECT_EQ(blocks_beside(frames_and_slopes(0), 2, Eigen::MatrixXd(0, 3)).cols(), 6);
}

TEST(TrajectoryFit, RefusesWhatDoesNotDetermineTheTrajectory) {
  const TrajectoryRows rows = frames_and_differences(5, 1);
  Eigen::VectorXd precisions = Eigen::VectorXd::Ones(9);
  precisions.head(5).setZero();
  EXPECT_THROW(TrajectoryFit(rows, precisions, Eigen::VectorXd::Ones(9)), FactorisationError);
  precisions(2) = INFINITY;
  EXPECT_THROW(TrajectoryFit(rows, precisions, Eigen::VectorXd::Ones(9)), FactorisationError);
  precisions(2) = 1;
  EXPECT_NO_THROW(TrajectoryFit(rows, precisions, Eigen::VectorXd::Ones(9)));
}

}  // namespace
}  // namespace talkgraph
