#include "experiment/series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment/page.h"
#include "tests/experiment/scored_nodes.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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

TEST_F(SeriesTest, PageHasContentsWithHowFarExperimentsAre) {
  folder_.write("thr ee.json", R"({ "extends": "two.json" })");
  Diagnostics diagnostics;
  auto all = load_series(series(R"({ "title": "A < B", "experiments": ["one.json", "two.json"] },
                                   { "title": "C", "experiments": ["thr ee.json"] }, { "title": "D" })"),
                         registry_, {}, diagnostics);
  ASSERT_TRUE(all) << diagnostics.str();
  auto& parts = all->sections[0].parts;
  parts[0].results.resize(1);
  parts[0].results[0].status = TrialResult::Status::finished;
  parts[1].results.resize(2);
  parts[1].results[0].status = TrialResult::Status::finished;
  parts[1].results[1].status = TrialResult::Status::failed;
  const auto page = series_page(*all);
  for (const char* text :
       {"<li><a href=\"#section-1\">A &lt; B</a>\n<ul>\n<li><a href=\"#experiment-one\">one</a>: finished</li>\n"
        "<li><a href=\"#experiment-two\">two</a>: 1 of 2 runs finished, 1 failed</li>\n</ul></li>\n",
        "<li><a href=\"#experiment-thr%20ee\">thr ee</a>: not run</li>", "<h2 id=\"section-1\">A &lt; B</h2>",
        "<h2 id=\"section-3\">D</h2>",
        "<h3 id=\"experiment-one\">one</h3>\n<p><a href=\"one/experiment.html\">Its own page</a> has every run: "
        "finished.</p>",
        "<h3 id=\"experiment-thr%20ee\">thr ee</h3>\n<p>Slopes</p>\n<p>It has not been run.</p>\n"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, Not(HasSubstr("thr%20ee/experiment.html"))) << "there is none yet";
  parts[1].results[1].status = TrialResult::Status::stopped;
  EXPECT_THAT(series_page(*all), HasSubstr("two</a>: 1 of 2 runs finished</li>"));
}

TEST_F(SeriesTest, PageSaysWhatMeasuresAreOnce) {
  Diagnostics diagnostics;
  auto all = load_series(series(R"({ "experiments": ["one.json", "two.json"] })"), registry_, {}, diagnostics);
  ASSERT_TRUE(all) << diagnostics.str();
  EXPECT_THAT(series_page(*all), Not(HasSubstr("What the measures are"))) << "there are no scores yet";
  for (auto& part : all->sections[0].parts) {
    part.results.resize(part.experiment.trials.size());
    part.results[0].observations = {
        {"scores", "", "", "y", 1}, {"scores", "", "", "title", 2}, {"scores", "", "", "z", 3}};
  }
  const std::string page = series_page(*all);
  const std::string legend =
      "<dl>\n<dt>y</dt><dd>its height at x, px</dd>\n<dt>title</dt><dd>letters of &lt;the title&gt;</dd>\n</dl>";
  EXPECT_THAT(page, HasSubstr(legend));
  EXPECT_EQ(page.find("<dl>"), page.rfind("<dl>"));
  EXPECT_THAT(page,
              HasSubstr("<th scope=\"col\"><abbr title=\"its height at x, px\">y</abbr></th><th scope=\"col\"><abbr "
                        "title=\"letters of &lt;the title&gt;\">title</abbr></th><th scope=\"col\">z</th>"));
  const auto& [experiment, graphs, results] = all->sections[0].parts[0];
  EXPECT_THAT(experiment_page(experiment, graphs, results), HasSubstr(legend));
}

TEST_F(SeriesTest, ALongLineOfSettingsIsFolded) {
  folder_.write("fixed.json", R"({ "graph": "graph.json", "tabulate": ["scores"], "set": { "scale": 12 } })");
  Diagnostics diagnostics;
  auto all = load_series(series(R"({ "experiments": ["fixed.json"] })"), registry_, {}, diagnostics);
  ASSERT_TRUE(all) << diagnostics.str();
  auto& [experiment, graphs, results] = all->sections[0].parts[0];
  const std::string folded =
      "<details><summary>What is set in all runs</summary>\n<p>In all runs <code>scale=12</code>";
  EXPECT_THAT(experiment_page(experiment, graphs, results), Not(HasSubstr(folded)));
  experiment.set.resize(7, experiment.set[0]);
  EXPECT_THAT(experiment_page(experiment, graphs, results), HasSubstr(folded));
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
  EXPECT_THAT(complaint(R"({ "experiments": ["none.json"] })"),
              AllOf(HasSubstr("story.json:1:"), HasSubstr("none.json is no file")));
  EXPECT_THAT(complaint(R"({ "experiments": ["story.json"] })"),
              HasSubstr("story.json is a series, which cannot be part"));
  EXPECT_THAT(complaint(R"({ "experiments": ["one.json", "one.json"] })"), HasSubstr("two experiments are called"));
  EXPECT_THAT(complaint(R"({ "table": { "columns": ["a", "b"], "rows": { "x": ["1"] } } })"),
              HasSubstr("row \"x\" has 1 cells in 2 columns"));
  EXPECT_THAT(complaint(R"({ "experiments": [3] })"), HasSubstr("story.json:1:"));
}

}  // namespace
}  // namespace talkgraph
