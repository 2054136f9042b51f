#include "nodes/write/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterWrite, EveryNodeIsASink) {
  Registry registry;
  register_write(registry);
  EXPECT_EQ(registry.names().size(), 10u);
  for (const auto& name : registry.names()) EXPECT_TRUE(registry.find(name)->sink) << name;
}

}  // namespace
}  // namespace talkgraph
