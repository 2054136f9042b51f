#include "nodes/mapping/trajectory_error.h"

#include <gtest/gtest.h>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

StateGaussians some_states(Eigen::Index kinds, double smoothness) {
  return {gaussian(3, 2 * kinds, 1), gaussian(3, 2 * kinds, 2).cwiseAbs2().array() + 0.1, kinds, smoothness};
}

StatePath some_path(const TrajectoryRows& rows, Eigen::Index frames, std::uint64_t seed) {
  Random random(seed);
  StatePath path{rows, {}, gaussian(frames, 1, seed).cwiseAbs2().array() + 0.1, {}};
  for (Eigen::Index t = 0; t < frames; ++t) path.states.push_back(static_cast<Eigen::Index>(random.below(3)));
  return path;
}

std::vector<StatePath> smooth_paths() {
  return {some_path(frames_and_differences(9, 3), 9, 1), some_path(frames_and_differences(1, 3), 1, 2),
          some_path(frames_and_differences(4, 3), 4, 3)};
}

std::vector<StatePath> sloping_paths() {
  std::vector<StatePath> paths{some_path(frames_and_slopes(12), 12, 1), some_path(frames_and_slopes(2), 2, 2)};
  for (StatePath& path : paths) path.shifts = gaussian(path.weights.size(), 4, 3);
  return paths;
}

std::vector<StatePath> curved_paths() {
  return {some_path(frames_slopes_and_curvatures(12), 12, 1), some_path(frames_slopes_and_curvatures(2), 2, 2)};
}

TEST(TrajectoryError, GradientIsThatOfCentralDifferences) {
  const Eigen::MatrixXd frames = gaussian(14, 2, 5);
  const auto check = [&](const StateGaussians& states, const std::vector<StatePath>& paths) {
    TrajectoryError error(states, paths, frames);
    const GradientCheck result = check_gradient(error, error.start());
    EXPECT_TRUE(result.evaluated && result.cost_consistent);
    EXPECT_LT(result.worst, 1e-7) << result.report();
  };
  check(some_states(1, 2), smooth_paths());
  check(some_states(2, 0), sloping_paths());
  check(some_states(3, 0), curved_paths());
}

TEST(TrajectoryError, IsHalfTheMeanSquareOfWhatTrajectoriesMiss) {
  const StateGaussians states = some_states(2, 0);
  const std::vector<StatePath> paths = sloping_paths();
  const Eigen::MatrixXd frames = gaussian(14, 2, 5);
  Eigen::MatrixXd found(14, 2);
  found << trajectory(states, paths[0]), trajectory(states, paths[1]);
  TrajectoryError error(states, paths, frames);
  double cost = 0;
  ASSERT_TRUE(error.evaluate(error.start(), cost, nullptr));
  EXPECT_NEAR(cost, (found - frames).squaredNorm() / 28, 1e-12);
}

TEST(TrajectoryError, NeverRises) {
  StateGaussians states = some_states(2, 0);
  const std::vector<StatePath> paths = sloping_paths();
  const Eigen::MatrixXd frames = gaussian(14, 2, 5);
  Context context;
  const std::vector<double> trace = lower_error(states, paths, frames, 50, "states", context);
  EXPECT_LT(trace.back(), 0.5 * trace.front());
  for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_LE(trace[i], trace[i - 1]);
  EXPECT_NEAR(lower_error(states, paths, frames, 0, "states", context).front(), trace.back(), 1e-12);
}

TEST(TrajectoryError, CannotBeEvaluatedWhereVariancesVanish) {
  const std::vector<StatePath> paths = smooth_paths();
  const Eigen::MatrixXd frames = gaussian(14, 2, 5);
  TrajectoryError error(some_states(1, 2), paths, frames);
  Eigen::VectorXd parameters = error.start();
  parameters.tail(6).setConstant(-1000);
  double cost = 0;
  EXPECT_FALSE(error.evaluate(parameters, cost, nullptr));
  StateGaussians states = some_states(1, 1e100);
  Context context;
  EXPECT_THROW(lower_error(states, paths, frames, 5, "states", context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
