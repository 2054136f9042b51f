#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "nodes/plot/bars.h"
#include "nodes/report/page.h"
#include "nodes/report/write.h"
#include "nodes/write/plot.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class Report : public testing::Test {
 protected:
  void SetUp() override { context.folder = folder.path(); }
  std::string read(const std::string& name) const { return folder.read(name); }

  const test::TemporaryFolder folder;
  Context context;
  Table table{"scores", "method", {"acc", "n"}, {"a, \"b\"", "c"}, {{0.5, 3}, {NAN, 4}}};
};

TEST_F(Report, WritesOnePageWithEverything) {
  WriteReport{"A <title>", "notes"}({{"scores", table}}, {{"p", {"plot", "<svg></svg>"}}},
                                    {{"s1", {"clips/s1.mp4", "clip"}}}, context);
  const std::string page = read("report.html");
  EXPECT_THAT(page, HasSubstr("<h1>A &lt;title&gt;</h1>"));
  EXPECT_THAT(page, HasSubstr("<td>0.5</td>"));
  EXPECT_THAT(page, HasSubstr("<svg></svg>"));
  EXPECT_THAT(page, HasSubstr("src=\"clips/s1.mp4\""));
  EXPECT_EQ(read("plots/p.svg"), "<svg></svg>");
  EXPECT_EQ(Json::parse(read("metrics.json"))["scores"]["rows"]["c"]["n"], 4);
}

TEST_F(Report, EscapesNamesAndPaths) {
  table.rows[1] = "<script>";
  WriteReport{"t", "a < b"}({{"scores", table}}, {{"p", {"R&D", "<svg></svg>"}}},
                            {{"a \"b\"", {"clips/50% #1.mp4", ""}}, {"strip", {"strips/s.png", ""}}}, context);
  const std::string page = read("report.html");
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">&lt;script&gt;</th>"));
  EXPECT_THAT(page, HasSubstr("<p>a &lt; b</p>"));
  EXPECT_THAT(page, HasSubstr("<figcaption>R&amp;D</figcaption>"));
  EXPECT_THAT(page, HasSubstr("aria-label=\"a &quot;b&quot;\" src=\"clips/50%25%20%231.mp4\""));
  EXPECT_THAT(page, HasSubstr("<img src=\"strips/s.png\" alt=\"strip\">"));
}

TEST_F(Report, HeadsPicturesAsPictures) {
  const auto page_of = [&](const Collected<Artifact>& clips) {
    WriteReport{}({}, {}, clips, context);
    return folder.read("report.html");
  };
  EXPECT_THAT(page_of({{"a", {"a.mp4", ""}}}), HasSubstr("<h2>Clips</h2>"));
  EXPECT_THAT(page_of({{"a", {"a.png", ""}}, {"b", {"b.svg", ""}}}), HasSubstr("<h2>Pictures</h2>"));
  EXPECT_THAT(page_of({{"a", {"a.png", ""}}, {"b", {"b.webm", ""}}}), HasSubstr("<h2>Clips and pictures</h2>"));
}

TEST_F(Report, LinksWhatNoPlayerShows) {
  EXPECT_THAT(html_clip("m", {"a b/model.h5", ""}), HasSubstr("<a href=\"a%20b/model.h5\">a b/model.h5</a>"));
}

TEST_F(Report, ShowsMeansWithTheirDeviations) {
  const std::string html =
      html_table("t", {"", "method", {"acc", "acc std", "x std"}, {"a", "b"}, {{0.5, 0.125, 1}, {0.25, NAN, NAN}}});
  EXPECT_THAT(html, HasSubstr("<caption>t</caption>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\">acc</th><th scope=\"col\">x std</th></tr>"));
  EXPECT_THAT(html, HasSubstr("<td>0.5 ± 0.12</td><td>1</td>"));
  EXPECT_THAT(html, HasSubstr("<td>0.25</td><td>–</td>"));
}

TEST_F(Report, FoldsWideTables) {
  Table wide{"A < B", "sequence", {}, {"s1"}, {{}}};
  const auto add = [&](const std::string& column) {
    wide.columns.push_back(column);
    wide.cells[0].push_back(1);
  };
  for (int i = 0; i < 20; ++i) add("acc: " + std::to_string(i));
  add("acc: 0 std");
  EXPECT_THAT(html_table("t", wide), testing::Not(HasSubstr("<details>"))) << "twenty are shown";
  add("acc: 20");
  const std::string html = html_table("t", wide);
  EXPECT_THAT(html, testing::StartsWith("<details><summary>A &lt; B</summary>\n<div class=\"wide\"><table>"));
  EXPECT_THAT(html, testing::EndsWith("</table></div>\n</details>\n"));
}

TEST_F(Report, MarksTheBest) {
  const std::string html = html_table("t", {"",
                                            "sequence",
                                            {"acc", "acc: a", "acc: b", "lag: a"},
                                            {"s1", "s2"},
                                            {{0.5, 0.25, 0.5 - 1e-16, 0.5}, {NAN, NAN, 0.5, 0.5}}});
  EXPECT_THAT(html, HasSubstr("<td>0.5</td><td>0.25</td><td class=\"best\">0.5</td><td>0.5</td>"));
  EXPECT_THAT(html, HasSubstr("<td>–</td><td>–</td><td>0.5</td><td>0.5</td>"));
}

TEST_F(Report, ShowsIntervalsAndTestsBelowTheirMeans) {
  const std::string html = html_table("t", {"",
                                            "method",
                                            {"acc", "acc std", "acc low", "acc high", "acc p", "so low"},
                                            {"a"},
                                            {{0.5, 0.125, 0.4, 0.6, 0.01, 2}}});
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\">acc</th><th scope=\"col\">so low</th></tr>"));
  EXPECT_THAT(
      html,
      HasSubstr(
          "<td><strong>0.5 ± 0.12</strong><br><small>0.4 to 0.6</small><br><small>p = 0.01</small></td><td>2</td>"));
}

TEST_F(Report, SaysWhatBoldNumbersAreWhereThereAreAny) {
  const auto table = [](double p) {
    return html_table("t", {"", "method", {"acc", "acc p", "so p"}, {"a", "b"}, {{0.5, NAN, 0.01}, {0.25, p, 0.01}}});
  };
  EXPECT_THAT(table(0.049), HasSubstr("<caption>t (bold: p below 0.05)</caption>"));
  EXPECT_THAT(table(0.049), HasSubstr("<td>0.5</td><td>0.01</td>"));
  EXPECT_THAT(table(0.049), HasSubstr("<td><strong>0.25</strong><br><small>p = 0.049</small></td>"));
  EXPECT_THAT(table(0.05), HasSubstr("<caption>t</caption>"));
  EXPECT_THAT(table(0.05), HasSubstr("<td>0.25<br><small>p = 0.05</small></td>"));
}

TEST_F(Report, NumbersHaveTheirMarkBesideThem) {
  EXPECT_EQ(html_number({0.5, 0.125, 0.25, 0.75}, " *"), "0.5 ± 0.12 *<br><small>0.25 to 0.75</small>");
  EXPECT_EQ(html_number({-0.0}), "0");
}

TEST_F(Report, HeadingsOfTablesMayBeHtml) {
  const std::string html = html_table("a < b", {"<abbr>acc</abbr>"}, {{heading_cell("x", 1)}, {number_cell("1")}});
  EXPECT_THAT(html, HasSubstr("<caption>a &lt; b</caption>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\"><abbr>acc</abbr></th>"));
  EXPECT_THAT(html, HasSubstr("colspan=\"1\" class=\"rows\"><span>x</span></th>"));
}

TEST_F(Report, ShowsIntervalsOfSharesThatHaveNoDeviation) {
  const std::string html =
      html_table("t", {"", "clips", {"share", "share low", "share high"}, {"a"}, {{0.5, 0.4, 0.6}}});
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\">share</th></tr>"));
  EXPECT_THAT(html, HasSubstr("<td>0.5<br><small>0.4 to 0.6</small></td></tr>"));
}

TEST_F(Report, IsWrittenOfNothingAsWell) {
  EXPECT_EQ(WriteReport{}({}, {}, {}, context).path, "report.html");
  EXPECT_EQ(read("metrics.json"), "{}\n");
}

TEST_F(Report, PlotsAreDrawnAsPictures) {
  const PlotBars bars{{"acc"}};
  const Plot plot = bars(Table{"t", "method", {"acc"}, {"a", "b"}, {{0.5}, {0.25}}});
  WritePlot{"bars", "plots", PlotFormat::png, 1}(plot, context);
  const cv::Mat picture = cv::imread(folder.file("plots/bars.png"));
  ASSERT_FALSE(picture.empty());
  cv::Scalar mean, deviation;
  cv::meanStdDev(picture, mean, deviation);
  EXPECT_GT(mean[0], 100);
  EXPECT_GT(deviation[0], 10) << "an empty picture";
}

}  // namespace
}  // namespace talkgraph
