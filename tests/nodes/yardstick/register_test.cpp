#include "nodes/yardstick/register.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(Register, DescribesEveryNode) {
  Registry registry;
  register_yardstick(registry);
  EXPECT_THAT(registry.names(),
              testing::ElementsAre("yardstick.mean", "yardstick.mean_train", "yardstick.neighbours",
                                   "yardstick.neighbours_train", "yardstick.ridge", "yardstick.ridge_train",
                                   "yardstick.trajectories", "yardstick.trajectories_train"));
}

}  // namespace
}  // namespace talkgraph
