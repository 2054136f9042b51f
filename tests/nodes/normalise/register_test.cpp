#include "nodes/normalise/register.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(Register, DescribesEveryNode) {
  Registry registry;
  register_normalise(registry);
  EXPECT_THAT(registry.names(),
              testing::ElementsAre("normalise.ica", "normalise.mean_center", "normalise.mean_of",
                                   "normalise.rank_style", "normalise.remove_style", "normalise.restore",
                                   "normalise.zscore_apply", "normalise.zscore_learn"));
}

}  // namespace
}  // namespace talkgraph
