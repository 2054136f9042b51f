#include <gtest/gtest.h>

#include "runtime/executor.h"
#include "tests/runtime/toy_nodes.h"

namespace talkgraph {
namespace {

TEST(LoadedGraph, Runs) {
  const Registry registry = toy::registry();
  Diagnostics diagnostics;
  const auto graph = load_graph_text("memory.json", R"({
    "nodes": {
      "applied": { "type": "toy.apply", "in": { "model": "model", "all": "features", "item": "source.all" } },
      "model": { "type": "toy.train", "in": { "all": "features" } },
      "features": { "type": "toy.map", "in": { "in": "source.some" } },
      "source": { "type": "toy.source", "params": { "to": 20 } },
      "both": { "type": "toy.train", "in": { "all": { "a": "model", "b": "model" } } }
    },
    "outputs": { "applied": "applied.out", "both": "both" }
  })",
                                     registry, diagnostics);
  ASSERT_TRUE(graph) << diagnostics.str();
  const auto result = run(*graph);
  EXPECT_EQ(result.output("applied").items.size(), 20u);
  EXPECT_TRUE(result.output("both").value);
}

}  // namespace
}  // namespace talkgraph
