#include "nodes/context/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterContext, DescribesEveryNode) {
  Registry registry;
  register_context(registry);
  for (const char* name : {"context.train", "context.decode", "context.segment", "context.segment_online",
                           "context.windows", "context.perplexity", "context.inspect", "context.sample"})
    EXPECT_TRUE(registry.find(name)) << name;
}

TEST(RegisterContext, SamplesHaveARateAboveZero) {
  Registry registry;
  register_context(registry);
  for (const auto& parameter : registry.find("context.sample")->parameters)
    if (parameter.name == "rate") {
      EXPECT_EQ(parameter.range.low, 0);
      EXPECT_TRUE(parameter.range.low_open);
    }
}

}  // namespace
}  // namespace talkgraph
