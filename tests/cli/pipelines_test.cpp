#include <gtest/gtest.h>

#include <filesystem>

#include "cli/look.h"
#include "cli/registry.h"
#include "experiment/experiment.h"
#include "graph/differences.h"

namespace talkgraph::cli {
namespace {

std::vector<std::string> pipelines() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TALKGRAPH_SOURCE_DIR "/pipelines"))
    if (entry.path().extension() == ".json" && !entry.path().filename().string().starts_with("talkgraph.") &&
        entry.path().parent_path().filename() != "experiments")
      files.push_back(entry.path().string());
  return files;
}

TEST(Pipelines, AreSound) {
  const Registry registry = all_nodes();
  EXPECT_GT(pipelines().size(), 8u);
  for (const auto& file : pipelines()) {
    Diagnostics diagnostics;
    EXPECT_TRUE(load_graph(file, registry, diagnostics)) << diagnostics.str();
  }
}

TEST(Experiments, AreSound) {
  const Registry registry = all_nodes();
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TALKGRAPH_SOURCE_DIR "/pipelines/experiments")) {
    Diagnostics diagnostics;
    const auto experiment = load_experiment(entry.path(), diagnostics);
    EXPECT_TRUE(experiment && load_trials(*experiment, registry, {}, diagnostics)) << diagnostics.str();
    ++count;
  }
  EXPECT_GT(count, 0u);
}

TEST(Pipelines, LoadAgainFromWhatARunFolderKeeps) {
  const Registry registry = all_nodes();
  for (const auto& file : pipelines()) {
    if (file.find("fragments") != std::string::npos) continue;
    Diagnostics diagnostics;
    const auto graph = load_graph(file, registry, diagnostics);
    ASSERT_TRUE(graph) << diagnostics.str();
    const auto again = load_graph_text("resolved.json", graph->resolved.dump(), registry, diagnostics);
    ASSERT_TRUE(again) << diagnostics.str();
    EXPECT_EQ(again->resolved, graph->resolved) << file;
  }
}

TEST(Pipelines, CanBeDrawn) {
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const auto graph = load_graph(TALKGRAPH_SOURCE_DIR "/pipelines/demo.json", registry, diagnostics);
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_NE(draw_dot(*graph).find("speaker.builtin"), std::string::npos);
  EXPECT_NE(draw_mermaid(*graph).find("==>|Track|"), std::string::npos);
}

TEST(Pipelines, CanBeCompared) {
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const std::string file = TALKGRAPH_SOURCE_DIR "/pipelines/demo.json";
  const auto a = load_graph(file, registry, diagnostics), b = load_graph(file, registry, diagnostics, {{"held_out=5"}}),
             c = load_graph(file, registry, diagnostics, {{"outputs.clips=null", "seed=3"}});
  ASSERT_TRUE(a && b && c) << diagnostics.str();
  EXPECT_EQ(diff_graphs(*a, *a), "");
  EXPECT_EQ(diff_graphs(*a, *b), "  recordings/params/held_out: 10 -> 5\n");
  EXPECT_EQ(differences(Json::parse(R"({ "g": "{ \"k\": 1 }", "x": [1] })"),
                        Json::parse(R"({ "x": [2], "g": "{ \"k\": 2 }" })")),
            (std::vector<std::string>{"g/k: 1 -> 2", "x: [1] -> [2]"}));
  EXPECT_EQ(diff_graphs(*a, *c), "  outputs/clips: \"face/encode.file\" -> nothing\n  seed: 1 -> 3\n");
}

}  // namespace
}  // namespace talkgraph::cli
