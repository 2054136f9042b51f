#include "experiment/series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiment/scored_nodes.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class SeriesTest : public test::ScoredExperiments {
 protected:
  std::string complaint(const std::string& sections, const std::vector<std::string>& sets = {}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_series(series(sections), registry_, sets, diagnostics));
    return diagnostics.str();
  }

  const Registry registry_ = test::scored_registry();
};

TEST_F(SeriesTest, IsToldFromAnExperiment) {
  EXPECT_TRUE(is_series(series("")));
  EXPECT_FALSE(is_series(folder_.file("one.json")));
  EXPECT_FALSE(is_series(folder_.write("broken.json", "{ \"sections\": [")));
  EXPECT_FALSE(is_series(folder_.file("not there.json")));
  EXPECT_FALSE(is_series(folder_.path()));
}

TEST_F(SeriesTest, ChangesGoToTheGraphsThatHaveWhatTheySet) {
  folder_.write("plain.json", R"({ "nodes": { "items": { "type": "test.items" },
      "score": { "type": "test.score", "in": { "number": "items" } } }, "outputs": { "scores": "score.scores" } })");
  folder_.write("three.json", R"({ "graph": "plain.json", "tabulate": ["scores"] })");
  const std::string sections = R"({ "title": "Both", "experiments": ["one.json", "three.json"] })";
  Diagnostics diagnostics;
  const auto both = load_series(series(sections), registry_, {"scale=5"}, diagnostics);
  ASSERT_TRUE(both) << diagnostics.str();
  EXPECT_EQ(both->sections[0].parts[0].graphs[0].resolved["nodes"]["score"]["params"]["scale"], 5);
  EXPECT_EQ(both->sections[0].parts[1].graphs[0].resolved["nodes"]["score"]["params"]["scale"], 1);
  EXPECT_THAT(complaint(sections, {"scal=5"}), HasSubstr("scal"));
}

TEST_F(SeriesTest, ChangesReplaceWhatExperimentsSetButNotWhatTheyVary) {
  folder_.write("fixed.json", R"({ "graph": "graph.json", "tabulate": ["scores"], "set": { "scale": 12 } })");
  const std::string sections = R"({ "title": "Both", "experiments": ["fixed.json", "two.json"] })";
  Diagnostics diagnostics;
  const auto both = load_series(series(R"({ "experiments": ["fixed.json"] })"), registry_, {"scale=16"}, diagnostics);
  ASSERT_TRUE(both) << diagnostics.str();
  EXPECT_EQ(both->sections[0].parts[0].graphs[0].resolved["nodes"]["score"]["params"]["scale"], 16);
  EXPECT_THAT(series_page(*both), HasSubstr("In all runs <code>scale=16</code>."));
  EXPECT_THAT(complaint(sections, {"scale=16"}), HasSubstr("two.json:2:"));
  EXPECT_THAT(complaint(sections, {"offset"}), HasSubstr("--set takes path=value"));
}

TEST_F(SeriesTest, MistakesAreLocated) {
  EXPECT_THAT(complaint(""), HasSubstr("at least one section"));
  EXPECT_THAT(complaint(R"({ "titel": "x" })"), HasSubstr("did you mean \"title\""));
  EXPECT_THAT(complaint(R"({ "experiments": "one.json" })"), HasSubstr("a list of files"));
  EXPECT_THAT(complaint(R"({ "experiments": ["none.json"] })"), HasSubstr("none.json: cannot be read"));
  EXPECT_THAT(complaint(R"({ "experiments": ["one.json", "one.json"] })"), HasSubstr("two experiments are called"));
  EXPECT_THAT(complaint(R"({ "table": { "columns": ["a", "b"], "rows": { "x": ["1"] } } })"),
              HasSubstr("row \"x\" has 1 cells in 2 columns"));
  EXPECT_THAT(complaint(R"({ "experiments": [3] })"), HasSubstr("story.json:1:"));
}

}  // namespace
}  // namespace talkgraph
