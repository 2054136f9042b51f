#include "cli/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/run.h"
#include "nodes/all_nodes.h"
#include "nodes/media/audio_file.h"
#include "nodes/types/recording.h"
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

// What is exported says how it came about, so it is written again when that is another; else it is found.
TEST(CacheCommand, ExportsFollowTheirProvenance) {
  const test::TemporaryFolder folder;
  write_audio(folder.path() / "tone.wav", Audio{Eigen::VectorXd::LinSpaced(1600, -0.5, 0.5), 16000});
  const std::string graph = folder.write("g.json", R"({ "nodes": {
      "files": { "type": "corpus.files", "params": { "files": ["tone.wav"] } },
      "parts": { "type": "corpus.parts", "in": { "recording": "files" } },
      "low": { "type": "media.resample", "in": { "audio": "parts.audio" }, "params": { "rate": 8000 } },
      "sound": { "type": "write.hdf5", "in": { "value": "low" } },
      "whole": { "type": "write.hdf5", "in": { "value": "files" } } } })");
  RunCommand run;
  run.cached = true;
  run.progress = ProgressStyle::quiet;
  run.cache = folder.path() / "cache";
  const auto registry = all_nodes();
  const auto calls = [&](const std::string& name) {
    run.folder = folder.path() / name;
    EXPECT_EQ(run_file(graph, run, registry), success);
    std::map<std::string, int> all;
    const Json report = Json::parse(folder.read(name + "/run.json"));
    for (const auto& node : report["nodes"]) all[node["name"]] = node["calls"];
    return all;
  };
  EXPECT_EQ(calls("first")["sound"], 1);
  Audio sound;
  fields(*hdf5_reader(folder.file("first/hdf5/sound/tone.h5")), sound);
  EXPECT_EQ(sound.samples.size(), 800);
  Recording recording;
  fields(*hdf5_reader(folder.file("first/hdf5/whole/tone.h5")), recording);
  EXPECT_EQ(recording.audio().samples.size(), 1600);
  EXPECT_EQ(calls("second")["sound"], 0);
  EXPECT_EQ(folder.read("first/hdf5/sound/tone.h5"), folder.read("second/hdf5/sound/tone.h5"));
  run.sets = {"seed=2"};
  EXPECT_EQ(calls("third")["sound"], 1) << "the seed stands in its provenance";
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
      "write": { "type": "write.audio", "in": { "audio": ")" +
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
  EXPECT_THAT(cache_info(Cache(run.cache)), HasSubstr("write.audio"));
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

// What can be written must be such that it can be loaded, but for a model that was never trained: no other type asks
// for that.
TEST(Nodes, WhatTheyGiveCanBeWrittenAndLoaded) {
  const test::TemporaryFolder folder;
  const Registry registry = all_nodes();
  for (const auto& name : registry.names()) {
    const NodeType& type = *registry.find(name);
    for (const auto& port : type.outputs) {
      const auto value = port.info->make();
      const std::string file = folder.file("value.h5");
      EXPECT_NO_THROW(write_hdf5(file, [&](Archive& ar) { port.info->visit(ar, value.get()); }))
          << name << " " << port.name;
      try {
        port.info->visit(*hdf5_reader(file), port.info->make().get());
      } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), HasSubstr("train it anew")) << name << " " << port.name;
      }
    }
  }
}

}  // namespace
}  // namespace talkgraph::cli
