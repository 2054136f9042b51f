#include "runtime/trace.h"

#include <gtest/gtest.h>

#include <set>

#include "runtime/executor.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

TEST(Trace, TellsOfEveryCallAndOfWhatWaits) {
  const test::TemporaryFolder folder;
  Registry registry;
  const Registry all = toy::registry();
  for (const auto& name : all.names()) {
    NodeType type = *all.find(name);
    type.stored = name == "toy.map";
    registry.add(type);
  }
  GraphBuilder b(registry);
  const int map = b.add("map", "toy.map", {b.add("source", "toy.source", {}, {{"to", 5}})});
  b.output("all", b.add("train", "toy.train", {map}));
  Cache cache(folder.path() / "cache");
  const auto events = [&](const std::string& name, Cache* kept) {
    Trace trace(folder.path() / name);
    RunOptions options;
    options.cache = kept;
    options.observers = {&trace};
    run(b.graph, options);
    return Json::parse(folder.read(name))["traceEvents"];
  };
  for (const char* cached : {"miss", "hit"}) {
    std::set<std::string> items;
    std::size_t counters = 0;
    for (const auto& e : events(cached, &cache)) {
      if (e["ph"] == "C") ++counters;
      if (e["ph"] != "X") continue;
      EXPECT_EQ(e["args"].contains("cache"), e["name"] == "map") << "only its results are kept";
      if (e["name"] != "map") continue;
      EXPECT_EQ(e["args"]["cache"], cached);
      EXPECT_GE(e["dur"], 0.0);
      EXPECT_GE(e["tid"], 1);
      items.insert(e["args"]["item"]);
    }
    EXPECT_EQ(items, (std::set<std::string>{"u0", "u1", "u2", "u3", "u4"}));
    EXPECT_EQ(counters, 5u);
  }
  for (const auto& e : events("plain", nullptr))
    EXPECT_FALSE(e["ph"] == "X" && e["args"].contains("cache")) << "there is none";
}

TEST(Trace, SaysAtTheStartThatItCannotBeWritten) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(Trace(folder.write("file", "x") + "/trace.json"), std::runtime_error);
  EXPECT_THROW(Trace(folder.path()), std::runtime_error);
  EXPECT_THROW(Trace("/proc/trace.json"), std::runtime_error);
  const Trace sound(folder.path() / "new/trace.json");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "new"));
}

}  // namespace
}  // namespace talkgraph
