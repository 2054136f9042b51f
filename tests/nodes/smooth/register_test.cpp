#include "nodes/smooth/register.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(Register, DescribesEveryNode) {
  Registry registry;
  register_smooth(registry);
  EXPECT_THAT(registry.names(), testing::ElementsAre("smooth.full_range", "smooth.lowpass", "smooth.lowpass_online"));
}

}  // namespace
}  // namespace talkgraph
