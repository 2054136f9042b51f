#include "nodes/evaluate/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterEvaluate, DescribesEveryNode) {
  Registry registry;
  register_evaluate(registry);
  for (const char* name :
       {"evaluate.score", "evaluate.summary", "evaluate.sequences", "evaluate.compare", "evaluate.columns",
        "evaluate.dimensions", "evaluate.join", "evaluate.lip_movement", "evaluate.lip_reader", "evaluate.lip_reading",
        "evaluate.alignment", "evaluate.explained", "evaluate.mouth_lag", "evaluate.mouth_opening", "evaluate.pictures",
        "evaluate.seams", "evaluate.tracking"})
    EXPECT_TRUE(registry.find(name)) << name;
}

}  // namespace
}  // namespace talkgraph
