#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "cli/look.h"
#include "experiment/meanings.h"
#include "experiment/series.h"
#include "graph/differences.h"
#include "graph/draft.h"
#include "nodes/all_nodes.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

std::vector<std::string> pipelines() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source("/pipelines")))
    if (entry.path().extension() == ".json" && !entry.path().filename().string().starts_with("talkgraph.") &&
        entry.path().parent_path().filename() != "experiments" && entry.path().parent_path().filename() != "studies")
      files.push_back(entry.path().string());
  return files;
}

std::string text_of(const std::string& path) {
  std::ifstream file(test::source(path));
  return {std::istreambuf_iterator<char>(file), {}};
}

Json nodes_of(const std::string& name) {
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const auto graph = load_graph(test::source("/pipelines/") + name, registry, diagnostics);
  if (!graph) throw std::runtime_error(diagnostics.str());
  return graph->resolved.at("nodes");
}

TEST(Pipelines, AreSound) {
  const Registry registry = all_nodes();
  EXPECT_GT(pipelines().size(), 8u);
  for (const auto& file : pipelines()) {
    Diagnostics diagnostics;
    EXPECT_TRUE(load_graph(file, registry, diagnostics)) << diagnostics.str();
  }
}

TEST(Pipelines, UseEveryParameterThatTheyHave) {
  for (const auto& file : pipelines()) {
    Diagnostics diagnostics;
    const auto json = detail::parse_file(file, diagnostics);
    ASSERT_TRUE(json) << diagnostics.str();
    const std::string text = json->plain().dump();
    for (const auto& parameter : detail::members_of(*json, "parameters")) {
      if (parameter.key == "title") continue;  // of a report, which some variants leave out
      EXPECT_NE(text.find("${" + parameter.key + "}"), std::string::npos) << file << ": " << parameter.key;
    }
  }
}

TEST(Pipelines, SettingsOfStatesReachThemInEveryRoundOfEm) {
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const auto graph = load_graph(test::source("/pipelines/fragments/learn-em-contexts.json"), registry, diagnostics,
                                {{"latent_dimension=7", "max_frames=99"}});
  ASSERT_TRUE(graph) << diagnostics.str();
  const Json nodes = graph->resolved.at("nodes");
  for (const std::string round : {"", "first_", "moved_"}) {
    EXPECT_EQ(nodes.at(round + "sgpdm").at("params").at("latent_dimension"), 7) << round;
    EXPECT_EQ(nodes.at(round + "windows").at("params").at("max_frames"), 99) << round;
  }
}

TEST(Experiments, AreSound) {
  const Registry registry = all_nodes();
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source("/pipelines/experiments"))) {
    Diagnostics diagnostics;
    if (is_series(entry.path())) {
      EXPECT_TRUE(load_series(entry.path(), registry, {}, diagnostics)) << diagnostics.str();
      continue;
    }
    const auto experiment = load_experiment(entry.path(), diagnostics);
    EXPECT_TRUE(experiment && load_trials(*experiment, registry, diagnostics)) << diagnostics.str();
    ++count;
  }
  EXPECT_GT(count, 0u);
}

TEST(Experiments, AreAllInTheEvaluation) {
  const std::set<std::string> others = {"evaluation.json", "prototypes-grid-s1.json"};  // the latter of faces alone
  const std::string evaluation = text_of("/pipelines/experiments/evaluation.json");
  for (const auto& entry : std::filesystem::directory_iterator(test::source("/pipelines/experiments"))) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(evaluation.find("\"" + name + "\"") == std::string::npos, others.contains(name)) << name;
  }
}

TEST(Experiments, OfAllMethodsTellWhoIsBestAndWhere) {
  const Registry registry = all_nodes();
  for (const std::string table : {"table-6-1-", "table-6-2-"})
    for (const std::string of : {"grid-s1", "lips", "demnow"}) {
      Diagnostics diagnostics;
      const auto experiment =
          load_experiment(test::source("/pipelines/experiments/") + table + of + ".json", diagnostics);
      ASSERT_TRUE(experiment) << diagnostics.str();
      const auto graphs = load_trials(*experiment, registry, diagnostics);
      ASSERT_TRUE(graphs) << diagnostics.str();
      const bool mouths = of == "grid-s1";
      const auto& names = experiment->tabulate.names;
      EXPECT_EQ(std::count(names.begin(), names.end(), "best"), 1) << table + of;
      EXPECT_EQ(std::count(names.begin(), names.end(), "mouths_best"), mouths) << table + of;
      for (const auto& graph : *graphs) {
        EXPECT_TRUE(graph.resolved["nodes"].contains("face/write_sequences"));
        EXPECT_EQ(graph.resolved["nodes"].contains("face/write_mouth_sequences"), mouths);
      }
    }
}

// The styles' files cannot extend GRID's, whose graph is another one.
TEST(Experiments, OfFiftySentencesHaveTheSameSettings) {
  const auto settings = [](const std::string& of) {
    Diagnostics diagnostics;
    const auto experiment =
        load_experiment(test::source("/pipelines/experiments/table-6-1-") + of + ".json", diagnostics);
    EXPECT_TRUE(experiment) << diagnostics.str();
    std::map<std::string, Json> values;
    for (const auto& change : experiment->set)
      if (change.path.starts_with("nodes.")) values[change.path] = change.value.plain();
    return values;
  };
  const auto of_grid = settings("grid-s1");
  EXPECT_GT(of_grid.size(), 20u);
  EXPECT_EQ(settings("lips"), of_grid);
  EXPECT_EQ(settings("demnow"), of_grid);
  const auto of_row = [&](const std::string& row) {
    const std::string graph = "nodes.face/" + row;
    std::map<std::string, Json> values;
    for (const auto& [path, value] : of_grid)
      if (path.starts_with(graph + "/") || path.starts_with(graph + ".")) values[path.substr(graph.size())] = value;
    EXPECT_FALSE(values.empty()) << row;
    return values;
  };
  EXPECT_EQ(of_row("neighbours_place"), of_row("neighbours_phones"));
  EXPECT_EQ(of_row("soft_place"), of_row("soft_learnt"));
}

TEST(Experiments, OfAllMethodsExplainTheirMeasures) {
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const auto graph = load_graph(test::source("/pipelines/compared-grid-s1.json"), registry, diagnostics);
  ASSERT_TRUE(graph) << diagnostics.str();
  std::set<std::string> measures;
  for (const auto& node : graph->resolved["nodes"])
    if (node["type"] == "evaluate.sequences")
      for (const auto& measure : node["params"]["scores"]) measures.insert(measure.get<std::string>());
  EXPECT_GT(measures.size(), 25u);
  EXPECT_EQ(meanings_of({"sequences", "acc behind", "acc won"}, {*graph}).size(), 3u);
  const std::string docs = text_of("/docs/measures.md");
  for (const auto& measure : measures) {
    const auto meanings = meanings_of({measure}, {*graph});
    ASSERT_EQ(meanings.size(), 1u) << measure;
    EXPECT_NE(docs.find("`" + measure + "`"), std::string::npos) << measure;
  }
}

TEST(Experiments, OfSpeechWriteNothing) {
  const Registry registry = all_nodes();
  for (const char* name : {"speech-parameters", "synchronisation-grid-s1"}) {
    Diagnostics diagnostics;
    const std::string file = test::source("/pipelines/experiments/") + std::string(name) + ".json";
    const auto experiment = load_experiment(file, diagnostics);
    ASSERT_TRUE(experiment) << diagnostics.str();
    const auto graphs = load_trials(*experiment, registry, diagnostics);
    ASSERT_TRUE(graphs) << diagnostics.str();
    for (const auto& graph : *graphs)
      for (const auto& node : graph.nodes) EXPECT_FALSE(node.type->sink) << node.name;
  }
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

void expect_settings_of_the_source(const Json& nodes, const std::string& learnt, int dimension,
                                   const std::string& approximation) {
  const Json& state = nodes.at(learnt + "/sgpdm").at("params");
  EXPECT_EQ(state.at("latent_dimension"), dimension) << learnt;
  EXPECT_EQ(state.at("approximation"), approximation) << learnt;
  EXPECT_EQ(state.at("inducing"), 100) << learnt;
  EXPECT_EQ(state.at("dynamics_inverse_width"), 1000) << learnt;
  EXPECT_EQ(state.at("likelihood_bias"), true) << learnt;
  EXPECT_EQ(state.at("dynamics_bias"), true) << learnt;
  EXPECT_EQ(nodes.at(learnt + "/contexts").at("params").at("order"), 6) << learnt;
}

TEST(Pipelines, OfTheSourcesCorporaLearnAsItDid) {
  expect_settings_of_the_source(nodes_of("lips.json"), "face/learnt", 5, "fitc");
  expect_settings_of_the_source(nodes_of("demnow.json"), "face/learnt", 4, "pitc");
}

TEST(Pipelines, ComparedInAStyleHaveTheSourcesSettingsInItsRowsAlone) {
  const Json chosen = nodes_of("compared-grid-s1.json");
  const auto expect = [&](const std::string& name, int dimension, const std::string& approximation, double width) {
    const Json nodes = nodes_of(name);
    for (const std::string row : {"learnt", "learnt_one", "learnt_phones", "learnt_static"})
      EXPECT_EQ(nodes.at("face/" + row + "/sgpdm").at("params"), chosen.at("face/" + row + "/sgpdm").at("params"))
          << name << ", " << row;
    for (const std::string row : {"learnt_source", "learnt_one_source"})
      expect_settings_of_the_source(nodes, "face/" + row, dimension, approximation);
    EXPECT_EQ(nodes.at("face/learnt_one_source/sgpdm").at("params").at("kbr_inverse_width"), width) << name;
  };
  expect("compared-lips.json", 5, "fitc", 1000);
  expect("compared-demnow.json", 4, "pitc", 0.001);
}

// They are laid over GRID's, so that the style stands in their file once more.
TEST(Pipelines, OfClipsHaveTheSettingsOfTheTables) {
  for (const std::string of : {"grid-s1", "lips"}) {
    const Json clips = nodes_of("compared-clips-" + of + ".json"), table = nodes_of("compared-" + of + ".json");
    int alike = 0;
    for (const auto& [key, node] : clips.items()) {
      if (!key.starts_with("face/") || !table.contains(key)) continue;
      EXPECT_EQ(node.at("type"), table.at(key).at("type")) << of << ", " << key;
      EXPECT_EQ(node.at("params"), table.at(key).at("params")) << of << ", " << key;
      ++alike;
    }
    EXPECT_GT(alike, 250) << of;
  }
}

TEST(Pipelines, OfMouthsHaveTheSettingsOfTheTable) {
  const Json mouths = nodes_of("mouth-measure-grid-s1.json"), faces = nodes_of("compared-grid-s1.json");
  std::set<std::string> methods;
  for (const auto& [key, node] : mouths.items()) {
    const std::string name = key.starts_with("said/") ? key.substr(5) : "";
    if (name.find('/') == std::string::npos || name.find("_score/") != std::string::npos) continue;
    if (name.starts_with("learnt_runs/") || name.starts_with("runs/")) continue;  // faces: switching-grid-s1.json
    EXPECT_EQ(node.at("type"), faces.at("face/" + name).at("type")) << name;
    EXPECT_EQ(node.at("params"), faces.at("face/" + name).at("params")) << name;
    methods.insert(name.substr(0, name.find('/')));
  }
  EXPECT_GT(methods.size(), 20u);
}

TEST(Pipelines, OfAllMethodsLeaveNoneOut) {
  for (const std::string table : {"compared.json", "mouth-methods.json"}) {
    const std::string text = text_of("/pipelines/fragments/" + table);
    for (const auto& entry : std::filesystem::directory_iterator(test::source("/pipelines/fragments/methods")))
      EXPECT_NE(text.find("\"methods/" + entry.path().filename().string() + "\""), std::string::npos)
          << table << " lacks " << entry.path().filename();
  }
}

// Each choice of speech parameters is one setting for training, synthesis and the graph that the model speaks with.
TEST(Pipelines, SpeakWithTheSpeechParametersOfTraining) {
  const Registry registry = all_nodes();
  const std::string fragments = test::source("/pipelines/fragments/");
  for (const char* name : {"demo.json", "grid-s1.json", "own.json"}) {
    Diagnostics diagnostics;
    const auto graph = load_graph(
        test::source("/pipelines/") + std::string(name), registry, diagnostics,
        {{"nodes.face.params.speech=" + fragments + "speech-direct.json",
          "nodes.face.params.features=" + fragments + "features/plp.json", "nodes.face.params.energy=null"}});
    ASSERT_TRUE(graph) << diagnostics.str();
    const Json& nodes = graph->resolved["nodes"];
    const Json spoken = Json::parse(nodes["face/save"]["params"]["speak"].get<std::string>())["nodes"];
    std::size_t same = 0;
    for (const auto& [key, node] : spoken.items()) {
      if (!key.starts_with("heard/speech/")) continue;
      for (const std::string heard : {"train_", "held_"})
        EXPECT_EQ(node["params"], nodes["face/" + heard + key]["params"]) << heard + key;
      ++same;
    }
    EXPECT_EQ(spoken["heard/speech/synchronise"]["type"], "sync.direct");
    EXPECT_TRUE(spoken.contains("heard/speech/features/loudness"));
    EXPECT_FALSE(spoken.contains("heard/speech/energy"));
    EXPECT_GT(same, 5u);
  }
}

TEST(Pipelines, SpeakByTheStatesThatWereLearnt) {
  const Registry registry = all_nodes();
  const std::string fragments = test::source("/pipelines/fragments/");
  Diagnostics diagnostics;
  const auto graph = load_graph(test::source("/pipelines/demo.json"), registry, diagnostics,
                                {{"nodes.face.params.learn=" + fragments + "learn-em.json",
                                  "nodes.face.params.imitate=" + fragments + "imitate-em.json"}});
  ASSERT_TRUE(graph) << diagnostics.str();
  const std::string speak = graph->resolved["nodes"]["face/save"]["params"]["speak"];
  const Json spoken = Json::parse(speak)["nodes"];
  EXPECT_EQ(spoken["said/segment"]["params"]["states"], "phones");
  EXPECT_EQ(spoken["said/resegment"]["type"], "mapping.resegment");
}

TEST(Pipelines, CanBeDrawn) {
  const Registry registry = all_nodes();
  for (const auto& file : pipelines()) {
    // Half a minute of Graphviz each; compared.json is drawn.
    if (file.find("/compared-") != std::string::npos) continue;
    Diagnostics diagnostics;
    const auto graph = load_graph(file, registry, diagnostics);
    ASSERT_TRUE(graph) << diagnostics.str();
    const std::string svg = draw_svg(*graph);
    for (const auto& node : graph->nodes) {
      EXPECT_NE(svg.find(">" + node.name.substr(node.name.rfind('/') + 1) + "<"), std::string::npos) << node.name;
      EXPECT_NE(svg.find(">" + node.type->name + "<"), std::string::npos) << node.name;
    }
  }
}

// A line is one of four statements; what is opened is closed; edges join declared nodes.
TEST(Pipelines, AreDrawnInSoundMermaid) {
  const std::regex node(R"#( +(n\d+)\["[^"]*"\])#"), open(R"#( +subgraph g\d+\["[^"]*"\])#"), close(" +end"),
      edge(R"#(  (n\d+) (-->|==>)\|"\w+"\| (n\d+))#");
  const Registry registry = all_nodes();
  for (const auto& file : pipelines()) {
    Diagnostics diagnostics;
    const auto graph = load_graph(file, registry, diagnostics);
    ASSERT_TRUE(graph) << diagnostics.str();
    std::istringstream lines(draw_mermaid(*graph));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "flowchart LR");
    std::set<std::string> nodes;
    int depth = 0;
    for (std::smatch m; std::getline(lines, line);) {
      if (std::regex_match(line, m, node))
        EXPECT_TRUE(nodes.insert(m[1]).second) << line;
      else if (std::regex_match(line, m, edge))
        EXPECT_TRUE(nodes.contains(m[1]) && nodes.contains(m[3])) << line;
      else if (std::regex_match(line, open))
        ++depth;
      else if (std::regex_match(line, close))
        EXPECT_GE(--depth, 0);
      else
        ADD_FAILURE() << file << ": " << line;
    }
    EXPECT_EQ(depth, 0);
    EXPECT_EQ(nodes.size(), graph->nodes.size());
  }
}

TEST(Pipelines, AreDrawnWithABoxAroundEachFragment) {
  Registry registry = all_nodes();
  Diagnostics diagnostics;
  const auto graph = load_graph_text("g.json", R"({ "nodes": {
    "a": { "type": "speaker.builtin" }, "hear/parts": { "type": "corpus.parts", "in": { "recording": "a" } },
    "hear/say\"so\"": { "type": "corpus.splits", "in": { "recordings": "a" } } },
    "outputs": { "x": "hear/parts.audio", "y": "hear/say\"so\"" } })",
                                     registry, diagnostics);
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(draw_mermaid(*graph), R"(flowchart LR
  n0["a<br/><i>speaker.builtin</i>"]
  subgraph g0["hear"]
    n1["parts<br/><i>corpus.parts</i>"]
    n2["say#quot;so#quot;<br/><i>corpus.splits</i>"]
  end
  n0 ==>|"Recording"| n1
  n0 ==>|"Recording"| n2
)");
  const std::string dot = draw_dot(*graph);
  EXPECT_NE(dot.find("  subgraph cluster_0 {\n    label=\"hear\";\n"), std::string::npos) << dot;
  EXPECT_NE(dot.find("    n2 [label=\"say\\\"so\\\"\\ncorpus.splits\"];\n"), std::string::npos) << dot;
  EXPECT_NE(dot.find("  n0 -> n1 [label=\"Recording\", penwidth=2.5];\n"), std::string::npos) << dot;
}

TEST(Pipelines, CanBeCompared) {
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const std::string file = test::source("/pipelines/demo.json");
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
