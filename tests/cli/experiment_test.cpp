#include "cli/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiment/scored_nodes.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;
using testing::Not;

class SeriesCommand : public test::ScoredExperiments {
 protected:
  int run(const std::string& file, const std::vector<std::string>& sets = {}) {
    cli::ExperimentCommand command;
    command.run.sets = sets;
    command.run.folder = folder_.path() / "out";
    command.run.progress = ProgressStyle::quiet;
    return cli::run_experiment(file, command, test::scored_registry());
  }
};

TEST_F(SeriesCommand, RunsAllAndTellsOfThemOnOnePage) {
  const auto file = series(R"({ "title": "First <1>", "text": "Once.\n\nTwice.", "experiments": ["one.json"] },
                              { "title": "Second", "experiments": ["two.json"] }, { "title": "End", "text": "So.", "table": { "columns": ["<a>"], "rows": { "r": ["x & y"] } } })");
  EXPECT_EQ(run(file), 0);
  const auto page = folder_.read("out/report.html");
  for (const char* text :
       {"<p>A story</p>", "<h2 id=\"section-1\">First &lt;1&gt;</h2>\n<p>Once.</p>\n<p>Twice.</p>",
        "<h2 id=\"section-2\">Second</h2>",
        "<p>Slopes</p>\n<p><a href=\"two/experiment.html\">Its own page</a> has every run: finished.",
        "one/trials/run/pictures/1.svg", "<h2 id=\"section-3\">End</h2>\n<p>So.</p>",
        "<th scope=\"col\" class=\"text\">&lt;a&gt;</th>", "<td class=\"text\">x &amp; y</td>"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, Not(HasSubstr("runs finished")));
  EXPECT_THAT(folder_.read("out/two/results.csv"), HasSubstr("scale"));
}

TEST_F(SeriesCommand, SaysWhatWasSetInAllRuns) {
  const auto file = folder_.write("fixed.json", R"({ "graph": "graph.json", "tabulate": ["scores"],
                                                     "set": { "scale": 12, "title": "<b>" } })");
  EXPECT_EQ(run(file, {"scale=16"}), 0);
  EXPECT_THAT(folder_.read("out/experiment.html"),
              HasSubstr("<p>In all runs <code>title=&lt;b&gt;</code>, <code>scale=16</code>.</p>"));
  EXPECT_THAT(folder_.read("out/results.csv"), HasSubstr("y,16"));
  EXPECT_THAT(folder_.read("out/trials/run/graph.resolved.json"), HasSubstr("\"scale\": 16"));
  EXPECT_EQ(run(folder_.file("two.json"), {"scale=16"}), 2);
}

TEST_F(SeriesCommand, AnExperimentThatFailsDoesNotStopTheOthers) {
  folder_.write("bad.json", R"({ "graph": "graph.json", "tabulate": ["scores"],
                                 "set": { "nodes.score.params.fail_on": 2 } })");
  const auto file = series(R"({ "title": "All", "experiments": ["bad.json", "one.json"] })");
  testing::internal::CaptureStderr();
  EXPECT_EQ(run(file), 1);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("this number is not liked"));
  const auto page = folder_.read("out/report.html");
  EXPECT_THAT(page, HasSubstr("<a href=\"#experiment-bad\">bad</a>: 0 of 1 runs finished, 1 failed</li>"));
  EXPECT_THAT(page, HasSubstr("one/trials/run"));
}

}  // namespace
}  // namespace talkgraph
