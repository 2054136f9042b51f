#include "cli/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/registry.h"
#include "cli/run.h"
#include "nodes/media/audio_file.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(CacheCommand, WritesSizesForPeople) {
  EXPECT_EQ(size_text(0), "0 B");
  EXPECT_EQ(size_text(1500), "1.5 kB");
  EXPECT_EQ(size_text(20'000'000'000), "20 GB");
}

// A run from another folder, of a graph whose node has another name, finds what the first one kept; its files are
// restored as they were.
TEST(CacheCommand, RunsShareWhatTheyKeep) {
  const test::TemporaryFolder folder;
  const auto graph = [&](const std::string& place, const std::string& node) {
    fs::create_directories(folder.path() / place);
    write_audio(folder.path() / place / "tone.wav", Audio{Eigen::VectorXd::LinSpaced(1600, -0.5, 0.5), 16000});
    return folder.write(place + "/g.json", R"({ "nodes": {
      "files": { "type": "corpus.files", "params": { "files": ["tone.wav"] } },
      ")" + node + R"(": { "type": "corpus.parts", "in": { "recording": "files" } },
      "write": { "type": "media.write_audio", "in": { "audio": ")" +
                                               node + R"(.audio" } } } })");
  };
  RunCommand run;
  run.cached = true;
  run.progress = ProgressStyle::quiet;
  run.cache = folder.path() / "cache";
  run.folder = folder.path() / "first";
  const auto registry = all_nodes();
  ASSERT_EQ(run_file(graph("a", "apart"), run, registry), success);
  run.folder = folder.path() / "second";
  ASSERT_EQ(run_file(graph("b", "parts"), run, registry), success);
  const Json record = Json::parse(folder.read("second/run.json"));
  for (const auto& node : record["nodes"]) EXPECT_EQ(node["calls"], node["type"] == "corpus.files" ? 1 : 0) << node;
  EXPECT_FALSE(folder.read("first/sound/tone.wav").empty());
  EXPECT_EQ(folder.read("first/sound/tone.wav"), folder.read("second/sound/tone.wav"));
  EXPECT_THAT(cache_info(Cache(run.cache)), HasSubstr("media.write_audio"));
}

TEST(CacheCommand, DamagedEntriesAreNamedAndRemoved) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path());
  const Key key = KeyMaker().add("k").key();
  cache.store(key, {{"recipe", {{"type", "toy"}}}}, {}, {});
  EXPECT_THAT(cache_info(cache), HasSubstr("toy"));
  folder.write("v2/" + key.str().substr(0, 2) + "/" + key.str() + "/stray", "x");
  EXPECT_EQ(cache_verify(cache), 1u);
  EXPECT_EQ(cache.entries().size(), 0u);
}

// What is kept must be such that it can be loaded.
TEST(Nodes, WhatTheyKeepCanBeLoaded) {
  const test::TemporaryFolder folder;
  const Registry registry = all_nodes();
  for (const auto& name : registry.names()) {
    const NodeType& type = *registry.find(name);
    if (!type.stored && !type.sink) continue;
    for (const auto& port : type.outputs) {
      const auto value = port.info->make();
      const std::string file = folder.file("value.h5");
      EXPECT_NO_THROW(port.info->visit(*hdf5_writer(file), value.get())) << name << " " << port.name;
      EXPECT_NO_THROW(port.info->visit(*hdf5_reader(file), port.info->make().get())) << name << " " << port.name;
    }
  }
}

}  // namespace
}  // namespace talkgraph::cli
