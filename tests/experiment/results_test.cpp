#include "experiment/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/page.h"
#include "nodes/types/report.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two settings of one factor, two seeds each.
Experiment two_settings() {
  Experiment e;
  e.name = "test";
  e.factors = {"filters"};
  e.settings = 2;
  e.tabulate.names = {"scores"};
  for (const int filters : {20, 26})
    for (const int seed : {1, 2}) {
      Trial& trial = e.trials.emplace_back();
      trial.name = "filters=" + std::to_string(filters) + ",seed=" + std::to_string(seed);
      trial.levels = {filters};
      trial.setting = filters == 20 ? 0 : 1;
      trial.seed = seed;
    }
  return e;
}

TrialResult result_of(std::vector<Observation> observations) {
  TrialResult r;
  r.status = TrialResult::Status::finished;
  r.observations = std::move(observations);
  return r;
}

TEST(Results, AreObservedFromTablesAndScores) {
  Experiment e;
  e.tabulate.names = {"table", "each"};
  RunResult run;
  Table table{"", "method", {"acc", "amse"}, {"ours"}, {{0.5, NAN}}};
  run.outputs.push_back({"table", false, Value::of(std::move(table)), {}});
  run.outputs.push_back(
      {"each", true, {}, {{"a", Value::of(Scores{{{"acc", 1}}})}, {"b", Value::of(Scores{{{"acc", 2}}})}}});
  const auto all = observe(e, run);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].row, "ours");
  EXPECT_EQ(all[0].measure, "acc");
  EXPECT_EQ(all[2].item, "b");
  EXPECT_EQ(all[2].value, 2);
}

TEST(Results, MeansAreOverRepeats) {
  const auto e = two_settings();
  const auto estimates =
      estimate(e, {result_of({{"scores", "", "ours", "acc", 1}, {"scores", "", "ours", "acc std", 9}}),
                   result_of({{"scores", "", "ours", "acc", 3}}), result_of({{"scores", "", "ours", "acc", 10}}),
                   result_of({})});
  ASSERT_EQ(estimates.size(), 2u);
  EXPECT_EQ(estimates[0].mean, 2);
  EXPECT_EQ(estimates[0].n, 2u);
  EXPECT_EQ(estimates[0].over, Estimate::Over::repeats);
  // Student's t of one degree of freedom is 12.706204736.
  EXPECT_NEAR(estimates[0].low, 2 - 12.706204736432095, 1e-9);
  EXPECT_NEAR(estimates[0].high, 2 + 12.706204736432095, 1e-9);
  EXPECT_NEAR(estimates[0].deviation, std::sqrt(2), 1e-12);
  EXPECT_EQ(estimates[1].setting, 1u);
  EXPECT_EQ(estimates[1].mean, 10);
  EXPECT_TRUE(std::isnan(estimates[1].low));
  EXPECT_TRUE(std::isnan(estimates[1].deviation));
}

TEST(Results, ItemsOfARepeatAreAveragedFirst) {
  const auto e = two_settings();
  const auto estimates = estimate(
      e, {result_of({{"s", "a", "", "acc", 1}, {"s", "b", "", "acc", 2}, {"s", "c", "", "acc", 3}}),
          result_of({{"s", "a", "", "acc", 5}}), result_of({{"s", "a", "", "acc", 1}, {"s", "b", "", "acc", 2}})});
  ASSERT_EQ(estimates.size(), 2u);
  EXPECT_EQ(estimates[0].mean, 3.5);
  EXPECT_EQ(estimates[0].n, 2u);
  EXPECT_EQ(estimates[1].over, Estimate::Over::items);
  EXPECT_EQ(estimates[1].n, 2u);
}

TEST(Results, TidyTableHasALineANumber) {
  const auto e = two_settings();
  const std::vector<TrialResult> results = {result_of({{"scores", "", "a, b", "acc", 0.25}}),
                                            result_of({{"scores", "k", "", "acc", INFINITY}})};
  EXPECT_EQ(tidy_csv(e, results),
            "trial,filters,seed,status,output,item,row,measure,value\n"
            "\"filters=20,seed=1\",20,1,finished,scores,,\"a, b\",acc,0.25\n"
            "\"filters=20,seed=2\",20,2,finished,scores,k,,acc,inf\n");
  const auto json = tidy_json(e, results);
  EXPECT_EQ(json[0]["filters"], 20);
  EXPECT_EQ(json[0]["value"], 0.25);
  EXPECT_TRUE(json[1]["value"].is_null());
  EXPECT_EQ(
      estimates_csv(e, estimate(e, {results[0]})),
      "filters,output,row,measure,n,over,partial,mean,std,low,high,p\n20,scores,\"a, b\",acc,1,repeats,no,0.25,,,,\n");
}

TEST(Results, IntervalsOfATableStayWithTheirScores) {
  const auto e = two_settings();
  const auto table = result_of({{"scores", "", "ours", "acc", 0.5},
                                {"scores", "", "ours", "acc std", 0.3},
                                {"scores", "", "ours", "acc low", 0.25},
                                {"scores", "", "ours", "acc high", 0.75},
                                {"scores", "", "ours", "acc p", 0.0125},
                                {"scores", "", "ours", "so low", 7},
                                {"scores", "", "mean", "acc", 0}});
  const std::vector<TrialResult> results = {table, {}, {}, {}};
  const auto estimates = estimate(e, results);
  ASSERT_EQ(estimates.size(), 3u);
  EXPECT_EQ(estimates[0].deviation, 0.3);
  EXPECT_EQ(estimates[0].low, 0.25);
  EXPECT_EQ(estimates[0].high, 0.75);
  EXPECT_EQ(estimates[0].p, 0.0125);
  EXPECT_TRUE(std::isnan(estimates[2].low));
  EXPECT_THAT(estimates_csv(e, estimates), HasSubstr("20,scores,ours,acc,1,table,no,0.5,0.3,0.25,0.75,0.0125\n"));
  const auto page = html_results(e, {}, results, "");
  EXPECT_THAT(page, HasSubstr("<th scope=\"col\">acc</th><th scope=\"col\">so low</th></tr>"));
  EXPECT_THAT(page, HasSubstr("<td><strong>0.5 ± 0.3</strong><br><small>0.25 to 0.75</small><br>"
                              "<small>p = 0.013</small></td><td>7</td>"));
  EXPECT_THAT(page, HasSubstr("<caption>scores (bold: p below 0.05)</caption>"));
  EXPECT_THAT(page, HasSubstr("<td>0</td><td>–</td>"));
  EXPECT_THAT(page, Not(HasSubstr("no confidence intervals")));
  EXPECT_THAT(page, Not(HasSubstr("Wilcoxon"))) << "where nothing is behind";
  EXPECT_THAT(tidy_csv(e, results), HasSubstr(",acc low,0.25\n")) << "all numbers";

  const auto repeated = estimate(e, {table, table, {}, {}});
  EXPECT_EQ(repeated[0].over, Estimate::Over::repeats);
  EXPECT_EQ(repeated[0].low, 0.5) << "no interval within a run";
  EXPECT_TRUE(std::isnan(repeated[0].p));
}

TEST(Results, SayWhatBehindIsAndItsP) {
  const auto page = html_results(two_settings(), {},
                                 {result_of({{"scores", "", "ours", "acc", 0.5},
                                             {"scores", "", "ours", "acc p", 0.25},
                                             {"best", "", "ours", "acc behind", 0.125},
                                             {"best", "", "ours", "acc behind p", 0.0625}}),
                                  {},
                                  {},
                                  {}},
                                 "");
  EXPECT_THAT(page, HasSubstr("and p. Behind is behind the method of the best mean, with p of Wilcoxon"));
  EXPECT_THAT(page, HasSubstr("over all pairs of methods"));
  EXPECT_THAT(page, HasSubstr("<td>0.125<br><small>p = 0.062</small></td>"));
}

TEST(Results, SayWhoIsBest) {
  const auto best = result_of({{"best", "", "a < b", "acc behind", 0},
                               {"best", "", "a < b", "acc won", 3},
                               {"best", "", "c", "acc behind", 0.125},
                               {"best", "", "c", "acc behind p", 0.0625}});
  EXPECT_THAT(
      html_results(two_settings(), {}, {best, {}, {}, {}}, ""),
      HasSubstr("<li>filters: 20. By acc <b>a &lt; b</b> is the best, but significantly (p below 0.05) ahead of "
                "none; it wins 3 recordings.</li>"));
  auto more = best;
  const auto of_d = result_of({{"best", "", "d", "acc behind", 0.5}, {"best", "", "d", "acc behind p", 0.01}});
  more.observations.insert(more.observations.end(), of_d.observations.begin(), of_d.observations.end());
  EXPECT_THAT(html_results(two_settings(), {}, {more, {}, {}, {}}, ""),
              HasSubstr("<b>a &lt; b</b> is ahead of all others (p below 0.05) but <b>c</b>, 0.12 behind; it wins 3 "
                        "recordings.</li>"));
}

TEST(Results, SayWhomMethodsAreTestedAgainst) {
  Graph graph;
  graph.resolved = {{"nodes",
                     {{"methods", {{"type", "statistics.methods"}, {"params", {{"against", "old & tried"}}}}},
                      {"variants", {{"type", "statistics.methods"}, {"params", {{"against", "old & tried"}}}}},
                      {"plain", {{"type", "statistics.methods"}}}}}};
  const auto page = [&](const std::string& measure) {
    const auto of = result_of({{"scores", "", "ours", measure, 0.5}, {"scores", "", "ours", measure + " p", 0.25}});
    return html_results(two_settings(), {graph, graph}, {of, {}, {}, {}}, "");
  };
  EXPECT_THAT(page("acc"), HasSubstr("test against old &amp; tried, sequence by sequence."));
  EXPECT_THAT(page("acc behind"), Not(HasSubstr("against")));
}

TEST(Results, DeviationsWithoutIntervalsAreOfTheTableToo) {
  const auto e = two_settings();
  const std::vector<TrialResult> results = {
      result_of({{"s", "", "all", "acc", 0.5}, {"s", "", "all", "acc std", 0.25}}), {}, {}, {}};
  EXPECT_EQ(estimate(e, results)[0].over, Estimate::Over::table);
  const auto page = html_results(e, {}, results, "");
  EXPECT_THAT(page, HasSubstr("<td>0.5 ± 0.25</td>"));
  EXPECT_THAT(page, HasSubstr("<caption>s</caption>")) << "nothing is bold";
  EXPECT_THAT(page, HasSubstr("where the table gives them"));
}

TEST(Results, RepeatsShowTheirDeviationAndInterval) {
  const auto e = two_settings();
  const auto page = html_results(e, {},
                                 {result_of({{"s", "", "", "acc", 1}}), result_of({{"s", "", "", "acc", 3}}),
                                  result_of({{"s", "", "", "acc", 4}}), result_of({{"s", "", "", "acc", 4}})},
                                 "");
  EXPECT_THAT(page, HasSubstr("<td>2 ± 1.4<br><small>-10.7 to 14.7</small></td>"));
  EXPECT_THAT(page, HasSubstr("<td>4 ± 0<br><small>4 to 4</small></td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"text\">26</td>")) << "a row a setting has its level beside it";
}

TEST(Results, RowsOfASettingStandBelowItsLevels) {
  const auto e = two_settings();
  const auto rows = result_of({{"s", "", "ours", "acc", 1}, {"s", "", "<theirs>", "acc", 2}});
  const auto page = html_results(e, {}, {rows, {}, rows, {}}, "");
  EXPECT_THAT(page, HasSubstr("<tr><th scope=\"col\" class=\"text\">row</th><th scope=\"col\">acc</th></tr>"));
  const std::string both =
      "</tr>\n<tr><td class=\"text\">ours</td><td>1</td></tr>\n"
      "<tr><td class=\"text\">&lt;theirs&gt;</td><td>2</td></tr>\n";
  for (const char* level : {"20", "26"})
    EXPECT_THAT(page, HasSubstr("<tr><th scope=\"rowgroup\" colspan=\"2\" class=\"rows\"><span>filters: " +
                                std::string(level) + "</span></th>" + both));
}

TEST(Results, PlotsAreLinesOverANumberAndBarsElse) {
  auto e = two_settings();
  const std::vector<TrialResult> results = {
      result_of({{"scores", "", "ours", "acc", 1}}), result_of({{"scores", "", "ours", "acc", 2}}),
      result_of({{"scores", "", "ours", "acc", 3}}), result_of({{"scores", "", "ours", "acc", 5}})};
  const auto lines = plot_estimates(e, estimate(e, results));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].svg, HasSubstr(">filters</text>"));
  for (auto& trial : e.trials) trial.levels[0] = trial.levels[0] == 20 ? "MFCC" : "PLP";
  const auto bars = plot_estimates(e, estimate(e, results));
  EXPECT_THAT(bars[0].svg, HasSubstr(">MFCC, ours</text>"));
  e.plot = {"acd"};
  EXPECT_TRUE(plot_estimates(e, estimate(e, results)).empty());
  EXPECT_THAT(missing_measures(e, estimate(e, results)),
              testing::ElementsAre("There is no measure \"acd\" to plot (did you mean \"acc\"?)."));
}

TEST(Results, PageShowsScoresClipsAndHowRunsWent) {
  const auto e = two_settings();
  std::vector<Graph> graphs(4);
  for (std::size_t g = 0; g < 4; ++g)
    graphs[g].resolved = {{"nodes", {{"mel", {{"params", {{"filters", g < 2 ? 20 : 26}}}}}}}, {"seed", 1 + g % 2}};
  std::vector<TrialResult> results(4);
  results[0] = result_of({{"scores", "", "ours", "acc", 1}});
  results[0].shown = {{"clips", "u1", Value::of(Artifact{"clips/u 1.mp4", ""})}};
  results[1].status = TrialResult::Status::failed;
  results[1].error = "no <sound>";
  const test::TemporaryFolder folder;
  write_results(e, graphs, results, folder.path());
  const auto page = folder.read("experiment.html");
  EXPECT_THAT(page, HasSubstr("1 of 4 runs finished"));
  EXPECT_THAT(page, HasSubstr("trials/filters%3D20%2Cseed%3D1/clips/u%201.mp4"));
  EXPECT_THAT(page, HasSubstr("failed: no &lt;sound&gt;"));
  EXPECT_THAT(page, HasSubstr("not run"));
  EXPECT_THAT(page, HasSubstr("mel/params/filters: 20 -&gt; 26"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  for (const char* file : {"results.csv", "results.json", "means.csv", "plots/scores.svg"})
    EXPECT_FALSE(folder.read(file).empty()) << file;
}

TEST(Results, LevelsThatTwoFactorsHaveKeepTheirNames) {
  Experiment e;
  e.factors = {"train", "test"};
  for (const auto* levels : {"clean noisy", "noisy clean"}) {
    Trial& trial = e.trials.emplace_back();
    trial.setting = e.trials.size() - 1;
    trial.levels = {std::string(levels).substr(0, 5), std::string(levels).substr(6)};
  }
  e.settings = 2;
  const auto bars =
      plot_estimates(e, estimate(e, {result_of({{"s", "", "", "acc", 1}}), result_of({{"s", "", "", "acc", 2}})}));
  EXPECT_THAT(bars[0].svg, HasSubstr(">train clean, test noisy</text>"));
}

TEST(Results, PartialOnesAreMarked) {
  const auto e = two_settings();
  auto partial = result_of({{"scores", "a", "", "acc", 1}});
  partial.status = TrialResult::Status::failed;
  partial.failures = 1;
  const std::vector<TrialResult> results = {result_of({{"scores", "a", "", "acc", 2}}), partial,
                                            result_of({{"scores", "a", "", "acc", 7}}), TrialResult{}};
  const auto estimates = estimate(e, results);
  EXPECT_TRUE(estimates[0].partial);
  EXPECT_FALSE(estimates[1].partial);
  EXPECT_THAT(tidy_csv(e, results), HasSubstr(",2,failed,scores,a,,acc,1\n"));
  EXPECT_EQ(tidy_json(e, results)[1]["status"], "failed");
  EXPECT_THAT(estimates_csv(e, estimates), HasSubstr("repeats,yes,"));
  std::vector<Graph> graphs(4);
  for (auto& graph : graphs) graph.resolved = {{"nodes", Json::object()}, {"seed", 1}};
  const auto page = experiment_page(e, graphs, results);
  EXPECT_THAT(page, HasSubstr("<td>1.5 ± 0.71 *<br>"));
  EXPECT_THAT(page, HasSubstr("Without items that failed"));
  EXPECT_THAT(page, HasSubstr("<td>7</td>"));
}

TEST(Results, FolderBelongsToOneExperiment) {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto complaint = [&](const std::string& file) -> std::string {
    try {
      claim_folder(out, file, false);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(folder.file("a.json")), "");
  EXPECT_EQ(complaint(folder.file("./a.json")), "") << "the same once more";
  EXPECT_THAT(complaint(folder.file("b.json")), HasSubstr("holds the results of " + folder.file("a.json")));
  claim_folder(out, folder.file("b.json"), true);
  EXPECT_THAT(complaint(folder.file("a.json")), HasSubstr("b.json"));
  std::filesystem::remove(out / "experiment.json");
  EXPECT_EQ(complaint(folder.file("a.json")), "") << "it is empty";
  std::filesystem::remove(out / "experiment.json");
  folder.write("out/thesis.tex", "mine");
  EXPECT_THAT(complaint(folder.file("a.json")), HasSubstr("holds files that no experiment wrote"));
  EXPECT_EQ(folder.read("out/thesis.tex"), "mine");
}

}  // namespace
}  // namespace talkgraph
