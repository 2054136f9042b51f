#include "runtime/why.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/executor.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// source -> first -> second -> model; the second map and the model are kept.
class Why : public testing::Test {
 protected:
  Why() {
    const Registry all = toy::registry();
    for (const auto& name : all.names()) {
      NodeType type = *all.find(name);
      type.stored = name == "toy.map" || name == "toy.train";
      registry_.add(type);
    }
  }
  Graph graph(int to, std::uint64_t k, bool direct = false) const {
    GraphBuilder b(registry_);
    b.graph.name = folder_.file("g.json");
    const int source = b.add("source", "toy.source", {}, {{"to", to}});
    const int drop = b.add("drop", "toy.fail_at", {source}, {{"key", k == 1 ? "none" : "nobody"}});
    const int map = b.add("map", "toy.map", {direct ? source : drop}, {{"k", k % 2}});
    b.output("model", b.add("model", "toy.train", {map}));
    return b.graph;
  }
  void go(const Graph& g) {
    RunOptions options;
    options.cache = &cache_;
    run(g, options);
  }
  std::string why(const Graph& g, std::optional<std::string> node = {}) const {
    return explain(g, Forecast(g, cache_), last_snapshot(cache_, g), node);
  }

  const test::TemporaryFolder folder_;
  Registry registry_;
  Cache cache_{folder_.path() / "cache"};
};

TEST_F(Why, AGraphThatNeverRan) {
  EXPECT_THAT(why(graph(3, 1)), AllOf(HasSubstr("3 to compute"), HasSubstr("has not run with this cache before")));
}

TEST_F(Why, AGraphThatRan) {
  go(graph(3, 1));
  EXPECT_THAT(why(graph(3, 1)),
              AllOf(HasSubstr("1 in the cache"), HasSubstr("3 not needed"), Not(HasSubstr("because"))));
}

TEST_F(Why, AParameterOfTheNodeOrOfOneBeforeIt) {
  go(graph(3, 1));
  EXPECT_THAT(why(graph(3, 2), "map"), AllOf(HasSubstr("3 to compute"), HasSubstr("because params/k: 1 -> 0")));
  EXPECT_THAT(why(graph(3, 3), "map"), HasSubstr(R"(because drop: params/key: "none" -> "nobody")"));
  EXPECT_THAT(why(graph(3, 2), "model"), HasSubstr("because map: params/k: 1 -> 0"));
}

TEST_F(Why, AWire) {
  go(graph(3, 1));
  EXPECT_THAT(why(graph(3, 1, true), "map"), HasSubstr("because in/in: "));
}

TEST_F(Why, Items) {
  go(graph(3, 1));
  EXPECT_THAT(why(graph(4, 1), "map"),
              AllOf(HasSubstr("1 to compute, 3 in the cache"), HasSubstr("item \"u3\" is new")));
  EXPECT_THAT(why(graph(2, 1), "model"), HasSubstr("item \"u2\" is gone"));
}

TEST_F(Why, WhatWasRemoved) {
  go(graph(3, 1));
  cache_.prune(0);
  EXPECT_THAT(why(graph(3, 1)), HasSubstr("not in the cache: the last run did not get so far, or it was removed"));
}

TEST_F(Why, NoSuchNode) {
  EXPECT_THROW(why(graph(3, 1), "mapp"), std::invalid_argument);
  EXPECT_THAT(why(graph(3, 1), "drop"), HasSubstr("its results are not kept"));
}

}  // namespace
}  // namespace talkgraph
