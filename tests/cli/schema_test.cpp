#include "graph/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "experiment/experiment.h"
#include "nodes/all_nodes.h"
#include "study/design.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

const std::string pipelines = test::source("/pipelines/");

/// What python3-jsonschema, which knows nothing of talkgraph, says of files; empty if it is content.
class Schema : public testing::Test {
 protected:
  Schema() : schema_(folder_.write("schema.json", json_schema(all_nodes()).dump())) {}
  std::string complaints(const std::string& files) { return complaints(files, schema_); }
  std::string complaints(const std::string& files, const std::string& schema) {
    const std::string out = folder_.file("out.txt");
    const std::string command = "python3 -W ignore -m jsonschema " + files + " '" + schema + "' > '" + out + "' 2>&1";
    const int code = std::system(command.c_str());
    const auto said = folder_.read("out.txt");
    return code == 0 ? "" : said.empty() ? "python3 -m jsonschema cannot be run" : said;
  }
  std::string complaints_of(const std::string& graph) {
    return complaints("-i '" + folder_.write("g.json", graph) + "'");
  }

  const test::TemporaryFolder folder_;
  const std::string schema_;
};

/// Files below pipelines/ that name a schema.
std::vector<fs::path> files_naming(const std::string& schema) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(pipelines)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream file(entry.path());
    const std::string named = Json::parse(file).value("$schema", "");
    if (fs::path(named).filename() == schema && fs::exists(entry.path().parent_path() / named))
      files.push_back(entry.path());
  }
  return files;
}

std::string instances(const std::vector<fs::path>& files) {
  std::string out;
  for (const auto& file : files) out += " -i '" + file.string() + "'";
  return out;
}

TEST_F(Schema, HoldsForEveryPipelineExperimentAndStudy) {
  EXPECT_EQ(
      complaints(instances(files_naming("talkgraph.schema.json")) + " -i '" + test::source("/cli/examples.json") + "'"),
      "");
  const std::string schema = folder_.write("experiment.schema.json", experiment_schema().dump());
  EXPECT_EQ(complaints(instances(files_naming("talkgraph.experiment.schema.json")), schema), "");
  const std::string of_studies = folder_.write("study.schema.json", study::design_schema().dump());
  EXPECT_EQ(complaints(instances(files_naming("talkgraph.study.schema.json")), of_studies), "");
}

TEST_F(Schema, OfStudiesFindsWhatIsWrong) {
  using testing::HasSubstr;
  const std::string schema = folder_.write("study.schema.json", study::design_schema().dump());
  const auto complaints_of_study = [&](const std::string& members) {
    return complaints("-i '" + folder_.write("s.json", "{" + members + "}") + "'", schema);
  };
  EXPECT_EQ(complaints_of_study(R"("extends": "study.json", "tests": { "turing": null, "read": { "clips": 4 } })"), "");
  EXPECT_THAT(complaints_of_study(R"("title": "Faces")"), HasSubstr("is not valid"));
  EXPECT_THAT(complaints_of_study(R"("extends": "study.json", "test": {})"), HasSubstr("test"));
  EXPECT_THAT(complaints_of_study(R"("extends": "study.json", "tests": { "a b": {} })"), HasSubstr("a b"));
  EXPECT_THAT(complaints_of_study(R"("extends": "study.json", "tests": { "a": { "clips": 0 } })"), HasSubstr("clips"));
}

TEST_F(Schema, RefusesNamesThatNoNodeMayHave) {
  for (const char* name : {"", "a.b", "a b", "inputs"})
    EXPECT_NE(complaints_of(Json{{"nodes", {{name, {{"type", "voice.speak"}}}}}}.dump()), "") << name;
}

TEST_F(Schema, FindsWhatIsWrong) {
  using testing::HasSubstr;
  EXPECT_EQ(
      complaints_of(
          R"({ "nodes": { "m": { "type": "speech.mel", "in": { "spectrum": "s" }, "params": { "filters": 20 } } } })"),
      "");
  EXPECT_THAT(
      complaints_of(
          R"({ "nodes": { "m": { "type": "speech.mel", "in": { "spectrum": "s" }, "params": { "filters": -1 } } } })"),
      HasSubstr("-1 is less than the minimum of 1"));
  EXPECT_THAT(
      complaints_of(
          R"({ "nodes": { "m": { "type": "speech.mel", "in": { "spectrum": "s" }, "params": { "filtres": 20 } } } })"),
      HasSubstr("filtres"));
  EXPECT_THAT(complaints_of(R"({ "nodes": { "m": { "type": "speech.mell", "in": { "spectrum": "s" } } } })"),
              HasSubstr("speech.mell"));
  EXPECT_THAT(complaints_of(R"({ "nodes": { "m": { "type": "speech.mel" } } })"),
              HasSubstr("'in' is a required property"));
  EXPECT_THAT(complaints_of(R"({ "nodes": { "m": { "type": "speech.mel", "in": { "spectrum": 3 } } } })"),
              HasSubstr("3"));
  EXPECT_THAT(complaints_of(R"({ "nodes": {}, "output": {} })"), HasSubstr("output"));
  EXPECT_EQ(complaints_of(R"({ "extends": "g.json", "nodes": { "m": { "params": {} }, "n": null } })"), "");
  EXPECT_THAT(complaints_of(R"({ "nodes": { "n": null } })"), HasSubstr("None"));
  EXPECT_THAT(complaints_of(R"({ "outputs": {} })"), HasSubstr("'nodes' is a required property"));
}

TEST_F(Schema, FindsWhatIsWrongInLists) {
  using testing::HasSubstr;
  const auto complaints_of_kernel = [&](const std::string& terms) {
    return complaints_of(R"({ "nodes": { "g": { "type": "latent.gp", "in": { "audio": "a", "visual": "v" },
        "params": { "kernel": )" +
                         terms + " } } } }");
  };
  EXPECT_EQ(complaints_of_kernel(R"([{ "kind": "linear" }, { "kind": "white", "variance": "${noise}" }, "${term}"])"),
            "");
  EXPECT_THAT(complaints_of_kernel(R"([{ "kind": "linar" }])"), HasSubstr("linar"));
  EXPECT_THAT(complaints_of_kernel(R"([{ "kind": "rbf", "width": 1 }])"), HasSubstr("width"));
  EXPECT_THAT(complaints_of_kernel(R"([{ "kind": "rbf", "variance": -1 }])"), HasSubstr("-1"));
  EXPECT_THAT(complaints_of_kernel(R"([{ "variance": 1 }])"), HasSubstr("'kind' is a required property"));
  EXPECT_THAT(complaints_of_kernel(R"(["white"])"), HasSubstr("white"));
}

TEST_F(Schema, OfExperimentsFindsWhatIsWrong) {
  using testing::HasSubstr;
  const std::string schema = folder_.write("experiment.schema.json", experiment_schema().dump());
  const auto complaints_of_experiment = [&](const std::string& members) {
    const auto file = folder_.write("e.json", R"({ "graph": "g.json", "tabulate": ["t"], )" + members + "}");
    return complaints("-i '" + file + "'", schema);
  };
  EXPECT_EQ(complaints_of_experiment(R"("vary": { "a": [1], "b": { "from": 1, "to": 2, "count": 3, "scale": "log" },
      "c": { "levels": { "x": { "k": 1 } } }, "d": { "together": { "e": [1, 2], "f": [3, 4] } } }, "seeds": [1, 2])"),
            "");
  EXPECT_THAT(complaints_of_experiment(R"("vry": {})"), HasSubstr("vry"));
  EXPECT_THAT(complaints_of_experiment(R"("vary": { "a": [] })"), HasSubstr("a"));
  EXPECT_THAT(complaints_of_experiment(R"("repeats": 0)"), HasSubstr("0 is less than the minimum of 1"));
}

TEST_F(Schema, BesideThePipelinesIsUpToDate) {
  const auto there = [](const char* name) {
    std::ifstream file(pipelines + name);
    return Json::parse(file, nullptr, false);
  };
  EXPECT_TRUE(there("talkgraph.schema.json") == json_schema(all_nodes()))
      << "stale: run build/talkgraph schema -o pipelines/talkgraph.schema.json";
  EXPECT_TRUE(there("talkgraph.experiment.schema.json") == experiment_schema())
      << "stale: run build/talkgraph schema --experiment -o pipelines/talkgraph.experiment.schema.json";
  EXPECT_TRUE(there("talkgraph.study.schema.json") == study::design_schema())
      << "stale: run build/talkgraph schema --study -o pipelines/talkgraph.study.schema.json";
}

TEST_F(Schema, IsNamedByEveryPipelineExperimentAndStudy) {
  std::size_t all = 0;
  for (const auto& entry : fs::recursive_directory_iterator(pipelines))
    all += entry.path().extension() == ".json" && !entry.path().filename().string().starts_with("talkgraph.");
  EXPECT_EQ(files_naming("talkgraph.schema.json").size() + files_naming("talkgraph.experiment.schema.json").size() +
                files_naming("talkgraph.study.schema.json").size(),
            all);
}

}  // namespace
}  // namespace talkgraph::cli
