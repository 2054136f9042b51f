#include "nodes/types/best_path.h"

#include <gtest/gtest.h>

#include <limits>

#include "graph/random.h"

namespace talkgraph {
namespace {

const auto none = [](Eigen::Index) { return Eigen::MatrixXd(0, 0); };

TEST(BestPath, IsTheBestOfAll) {
  Random random(7);
  const std::vector<Eigen::Index> states = {3, 1, 2, 4, 3};
  for (int round = 0; round < 30; ++round) {
    std::vector<Eigen::VectorXd> scores;
    std::vector<Eigen::MatrixXd> steps(1);
    for (std::size_t t = 0; t < states.size(); ++t) {
      scores.emplace_back(states[t]);
      if (t > 0) steps.emplace_back(states[t - 1], states[t]);
      for (auto& v : scores[t].reshaped()) v = random.uniform();
      for (auto& v : steps[t].reshaped()) v = random.uniform();
    }
    const auto sum = [&](const std::vector<Eigen::Index>& path) {
      double total = scores[0](path[0]);
      for (std::size_t t = 1; t < path.size(); ++t) total += scores[t](path[t]) + steps[t](path[t - 1], path[t]);
      return total;
    };
    double best = -std::numeric_limits<double>::infinity();
    for (Eigen::Index code = 0; code < 3 * 2 * 4 * 3; ++code)
      best = std::max(best, sum({code % 3, 0, code / 3 % 2, code / 6 % 4, code / 24}));
    const auto path = best_path(
        5, [&](Eigen::Index t) { return scores[static_cast<std::size_t>(t)]; },
        [&](Eigen::Index t) -> const Eigen::MatrixXd& { return steps[static_cast<std::size_t>(t)]; });
    EXPECT_NEAR(sum(path.states), best, 1e-12);
    EXPECT_NEAR(path.scores.back().maxCoeff(), best, 1e-12);
  }
}

TEST(BestPath, OfEqualsTakesTheLowerStates) {
  const auto path = best_path(
      3, [](Eigen::Index) { return Eigen::Vector2d(1, 1); },
      [](Eigen::Index) { return Eigen::MatrixXd(Eigen::MatrixXd::Zero(2, 2)); });
  EXPECT_EQ(path.states, (std::vector<Eigen::Index>{0, 0, 0}));
}

TEST(BestPath, OfOneFrameAndOfNone) {
  const auto scores = [](Eigen::Index) { return Eigen::Vector3d(1, 3, 2); };
  EXPECT_EQ(best_path(1, scores, none).states, std::vector<Eigen::Index>{1});
  EXPECT_TRUE(best_path(0, scores, none).states.empty());
}

}  // namespace
}  // namespace talkgraph
