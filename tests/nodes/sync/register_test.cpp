#include "nodes/sync/register.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(Register, DescribesEveryNode) {
  Registry registry;
  register_sync(registry);
  EXPECT_THAT(registry.names(), testing::ElementsAre("sync.direct", "sync.frames", "sync.median", "sync.polyphase",
                                                     "sync.quadrature", "sync.shift", "sync.together"));
}

}  // namespace
}  // namespace talkgraph
