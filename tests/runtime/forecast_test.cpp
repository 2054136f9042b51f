#include "runtime/forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "runtime/executor.h"
#include "runtime/recipe.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

/// The toys, some of them worth keeping.
Registry toys(const std::vector<std::string>& stored) {
  Registry out;
  const Registry all = toy::registry();
  for (const auto& name : all.names()) {
    NodeType type = *all.find(name);
    type.stored = std::find(stored.begin(), stored.end(), name) != stored.end();
    out.add(type);
  }
  return out;
}

/// source -> map -> train -> states -> map -> train, the maps and the trained models kept.
class CachedRun : public testing::TestWithParam<Executor> {
 protected:
  CachedRun() { options_.cache = &cache_; }
  void SetUp() override { options_.executor = GetParam(); }

  Graph graph(std::uint64_t first = 1, std::uint64_t second = 2, int to = 10) {
    GraphBuilder b(registry_);
    const int source = b.add("source", "toy.source", {}, {{"to", to}});
    const int first_map = b.add("first", "toy.map", {source}, {{"k", first}});
    const int model = b.add("model", "toy.train", {first_map});
    const int states = b.add("states", "toy.states", {first_map, model});
    const int second_map = b.add("second", "toy.map", {states}, {{"k", second}});
    b.output("trained", b.add("last", "toy.train", {second_map}));
    b.output("applied", b.add("apply", "toy.apply", {model, first_map, source}));
    return b.graph;
  }
  static std::map<std::string, std::uint64_t> marks(const RunResult& result) {
    std::map<std::string, std::uint64_t> all;
    for (const auto& output : result.outputs) {
      if (output.value) all[output.name] = output.value.get<Mark>().bits;
      for (const auto& item : output.items) all[output.name + "/" + item.key] = item.value.get<Mark>().bits;
    }
    return all;
  }
  std::map<std::string, std::uint64_t> plain(const Graph& g) {
    RunOptions options;
    return marks(run(g, options));
  }
  const NodeStats& stats(const RunResult& result, const Graph& g, const std::string& name) {
    for (std::size_t n = 0; n < g.nodes.size(); ++n)
      if (g.nodes[n].name == name) return result.nodes[n];
    throw std::out_of_range(name);
  }

  const test::TemporaryFolder folder_;
  const Registry registry_ = toys({"toy.map", "toy.train"});
  Cache cache_{folder_.path() / "cache"};
  RunOptions options_;
};

TEST_P(CachedRun, TheSecondTimeNothingIsCalledThatWasKept) {
  const Graph g = graph();
  const auto expected = plain(g);
  const auto first = run(g, options_);
  EXPECT_EQ(marks(first), expected);
  const auto second = run(g, options_);
  EXPECT_EQ(marks(second), expected);
  EXPECT_EQ(stats(second, g, "last").loaded, 1u);
  for (const char* skipped : {"states", "second"}) EXPECT_EQ(stats(second, g, skipped).calls, 0u) << skipped;
  EXPECT_EQ(stats(second, g, "first").loaded, 10u) << "apply is not kept and reads it";
  EXPECT_GT(stats(second, g, "first").kept, 0u);
  EXPECT_EQ(stats(second, g, "first").kept, stats(first, g, "first").kept) << "as large as it was when it was made";
  EXPECT_EQ(stats(second, g, "first").calls, 0u);
}

TEST_P(CachedRun, WhatComesBeforeAChangeIsNotMadeAgain) {
  run(graph(), options_);
  const Graph changed = graph(1, 3);
  const auto result = run(changed, options_);
  EXPECT_EQ(marks(result), plain(changed));
  EXPECT_EQ(stats(result, changed, "first").calls, 0u);
  EXPECT_EQ(stats(result, changed, "model").loaded, 1u);
  EXPECT_EQ(stats(result, changed, "second").loaded, 0u);
  EXPECT_EQ(stats(result, changed, "last").calls, 1u);
}

TEST_P(CachedRun, ANewItemAloneIsMade) {
  run(graph(1, 2, 10), options_);
  const Graph longer = graph(1, 2, 11);
  const auto result = run(longer, options_);
  EXPECT_EQ(marks(result), plain(longer));
  EXPECT_EQ(stats(result, longer, "first").calls, 1u);
  EXPECT_EQ(stats(result, longer, "first").loaded, 10u);
  EXPECT_EQ(stats(result, longer, "model").calls, 1u);
}

TEST_P(CachedRun, RunsBesideEachOtherMakeAResultOnce) {
  const Graph g = graph(1, 2, 30);
  const auto expected = plain(g);
  toy::dawdle_at_most = 2000;
  std::vector<RunResult> results(3);
  std::vector<std::jthread> runs;
  for (auto& result : results) runs.emplace_back([&] { result = run(g, options_); });
  runs.clear();
  toy::dawdle_at_most = 0;
  for (const char* name : {"first", "second", "model", "last"}) {
    std::uint64_t calls = 0;
    for (const auto& result : results) calls += stats(result, g, name).calls;
    EXPECT_EQ(calls, stats(run(g, {}), g, name).calls) << name;
  }
  for (const auto& result : results) EXPECT_EQ(marks(result), expected);
}

TEST_P(CachedRun, TheSeedCountsWhereItIsUsed) {
  Graph g = graph();
  run(g, options_);
  g.seed = 5;
  EXPECT_EQ(marks(run(g, options_)), plain(g));
}

TEST_P(CachedRun, DamagedEntriesAreMadeAnew) {
  const Graph g = graph();
  run(g, options_);
  for (const auto& entry : cache_.entries()) {
    const auto name = entry.key.str();
    std::filesystem::resize_file(cache_.folder() / name.substr(0, 2) / name / "0.h5", 100);
  }
  EXPECT_EQ(marks(run(g, options_)), plain(g));
  for (const auto& entry : cache_.entries()) EXPECT_EQ(cache_.verify(entry.key), "");
}

TEST_P(CachedRun, ACacheTooSmallForARunServesIt) {
  const Graph g = graph(1, 2, 40);
  for (int i = 0; i < 3; ++i) {
    Cache tiny(folder_.path() / "tiny", 1);
    options_.cache = &tiny;
    EXPECT_EQ(marks(run(g, options_)), plain(g));
  }
}

TEST_P(CachedRun, WhatAFailureTouchedIsNotKept) {
  const Registry registry = toys({"toy.map", "toy.train", "toy.fail_at"});
  const auto make = [&](const std::string& key) {
    GraphBuilder b(registry);
    const int source = b.add("source", "toy.source", {}, {{"to", 5}});
    const int fail = b.add("fail", "toy.fail_at", {source}, {{"key", key}});
    b.output("map", b.add("map", "toy.map", {fail}));
    b.output("model", b.add("model", "toy.train", {fail}));
    return b.graph;
  };
  options_.keep_going = true;
  const auto broken = run(make("u3"), options_);
  EXPECT_EQ(broken.failures.size(), 1u);
  EXPECT_EQ(cache_.entries().size(), 8u) << "four items of two nodes; not the fifth, not the model";
  const auto again = run(make("u3"), options_);
  EXPECT_EQ(again.failures.size(), 1u) << "it is told every time";
}

TEST_P(CachedRun, ASourceThatFailsIsToldEvenIfAllElseIsKept) {
  GraphBuilder b(registry_);
  b.output("map", b.add("map", "toy.map", {b.add("source", "toy.gap")}));
  options_.keep_going = true;
  run(b.graph, options_);
  EXPECT_EQ(run(b.graph, options_).failures.size(), 1u);
  EXPECT_TRUE(Forecast(b.graph, *options_.cache).fails(0));
}

INSTANTIATE_TEST_SUITE_P(Both, CachedRun, testing::Values(Executor::flow, Executor::serial),
                         [](const auto& i) { return i.param == Executor::flow ? "Flow" : "Serial"; });

TEST(Recipe, NamesWhatCountsAndNothingElse) {
  const Registry registry = toy::registry();
  const auto of = [&](const std::string& name, std::uint64_t k, std::uint64_t seed) {
    GraphBuilder b(registry);
    b.add("source", "toy.source");
    b.add(name, "toy.map", {0}, {{"k", k}});
    b.graph.seed = seed;
    return recipe(b.graph, 1);
  };
  EXPECT_EQ(of("a", 1, 1), of("b", 1, 1));
  EXPECT_NE(of("a", 1, 1), of("a", 2, 1));
  EXPECT_NE(of("a", 1, 1), of("a", 1, 2)) << "a map draws random numbers";
}

struct Sheet {
  FilePath file;
};
void parameters(Parameters<Sheet>& p) { p.param("file", &Sheet::file); }

struct Play {
  std::vector<Sheet> sheets;
  Mark operator()() const { return {}; }
};
void describe(Description<Play>& d) {
  d.type("test.play").summary("plays what is written").output("out");
  d.param("sheets", &Play::sheets);
}

TEST(Recipe, HoldsWhatLiesInFilesThatAListOfStructsNames) {
  Registry registry;
  registry.add<Play>();
  const test::TemporaryFolder folder;
  const auto of = [&](const std::string& file) {
    GraphBuilder b(registry);
    b.add("play", "test.play", {}, {{"sheets", {{{"file", file}}}}});
    return recipe(b.graph, 0);
  };
  EXPECT_EQ(of(folder.write("a", "one")), of(folder.write("b", "one")));
  EXPECT_NE(of(folder.write("a", "one")), of(folder.write("a", "two")));
}

TEST(Key, OfFilesFollowsTheirContent) {
  const test::TemporaryFolder folder;
  const auto a = file_key(folder.write("a/x", "one"));
  EXPECT_EQ(a, file_key(folder.write("b/y", "one")));
  EXPECT_NE(a, file_key(folder.write("b/z", "two")));
  EXPECT_NE(file_key(folder.path() / "a"), file_key(folder.path() / "b"));
  EXPECT_FALSE(file_key(folder.path() / "none"));
}

TEST(Key, FilesThatChangeAfterTheyWereReadAreNoticed) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("x", "one");
  std::vector<FileStamp> stamps;
  {
    FilesRead outer;
    {
      FilesRead read;
      file_key(file);
      stamps = read.stamps;
    }
    EXPECT_TRUE(outer.stamps.empty());
  }
  ASSERT_EQ(stamps.size(), 1u);
  EXPECT_EQ(FileStamp::of(file), stamps[0]);
  std::filesystem::remove(file);
  EXPECT_NE(FileStamp::of(file), stamps[0]);
  folder.write("x", "one");
  EXPECT_NE(FileStamp::of(file), stamps[0]) << "written again with the same content, maybe another in between";
}

TEST(Key, PartsDoNotRunTogether) {
  EXPECT_NE(KeyMaker().add("ab").add("c").key(), KeyMaker().add("a").add("bc").key());
  EXPECT_EQ(KeyMaker().add("a").key(), KeyMaker().add("a").key());
  EXPECT_EQ(KeyMaker().add("a").key().str().size(), 32u);
}

}  // namespace
}  // namespace talkgraph
