#include "graph/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "cli/registry.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

const std::string pipelines = TALKGRAPH_SOURCE_DIR "/pipelines/";

/// What python3-jsonschema, which knows nothing of talkgraph, says of files; empty if it is content.
class Schema : public testing::Test {
 protected:
  Schema() : schema_(folder_.write("schema.json", json_schema(all_nodes()).dump())) {}
  std::string complaints(const std::string& files) {
    const std::string out = folder_.file("out.txt");
    const std::string command = "python3 -W ignore -m jsonschema " + files + " '" + schema_ + "' > '" + out + "' 2>&1";
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

TEST_F(Schema, HoldsForEveryPipeline) {
  std::string files;
  for (const auto& entry : fs::recursive_directory_iterator(pipelines))
    if (entry.path().extension() == ".json" && entry.path().filename() != "talkgraph.schema.json")
      files += " -i '" + entry.path().string() + "'";
  EXPECT_EQ(complaints(files), "");
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
}

TEST_F(Schema, BesideThePipelinesIsUpToDate) {
  std::ifstream file(pipelines + "talkgraph.schema.json");
  const Json there = Json::parse(file, nullptr, false);
  EXPECT_TRUE(there == json_schema(all_nodes()))
      << "stale: run build/talkgraph schema -o pipelines/talkgraph.schema.json";
}

TEST_F(Schema, IsNamedByEveryPipeline) {
  for (const auto& entry : fs::recursive_directory_iterator(pipelines)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "talkgraph.schema.json") continue;
    std::ifstream file(entry.path());
    const std::string named = Json::parse(file).value("$schema", "");
    EXPECT_TRUE(fs::exists(entry.path().parent_path() / named) && named.ends_with("talkgraph.schema.json"))
        << entry.path();
  }
}

}  // namespace
}  // namespace talkgraph::cli
