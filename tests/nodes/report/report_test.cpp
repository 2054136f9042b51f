#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "nodes/report/files.h"
#include "nodes/report/page.h"
#include "nodes/report/write.h"
#include "nodes/report/write_plot.h"
#include "nodes/report/write_table.h"
#include "nodes/report/write_track.h"
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

TEST_F(Report, WritesTablesAsCsvAndJson) {
  EXPECT_EQ((WriteTable{"t"}(table, context)).path, "t.csv");
  EXPECT_EQ(read("t.csv"), "method,acc,n\n\"a, \"\"b\"\"\",0.5,3\nc,,4\n");
  const Json json = Json::parse(read("t.json"));
  EXPECT_EQ(json["rows"]["c"]["n"], 4);
  EXPECT_TRUE(json["rows"]["c"]["acc"].is_null());
}

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

TEST_F(Report, ShowsMeansWithTheirDeviations) {
  const std::string html =
      html_table("t", {"", "method", {"acc", "acc std", "x std"}, {"a", "b"}, {{0.5, 0.125, 1}, {0.25, NAN, NAN}}});
  EXPECT_THAT(html, HasSubstr("<caption>t</caption>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\">acc</th><th scope=\"col\">x std</th></tr>"));
  EXPECT_THAT(html, HasSubstr("<td>0.5 ± 0.12</td><td>1</td>"));
  EXPECT_THAT(html, HasSubstr("<td>0.25</td><td>–</td>"));
}

TEST_F(Report, IsWrittenOfNothingAsWell) {
  EXPECT_EQ(WriteReport{}({}, {}, {}, context).path, "report.html");
  EXPECT_EQ(read("metrics.json"), "{}\n");
}

TEST_F(Report, WritesPlots) {
  const Plot plot{"p", "<svg></svg>"};
  EXPECT_EQ((WritePlot{"one"}(plot, context)).path, "plots/one.svg");
  EXPECT_EQ(read("plots/one.svg"), "<svg></svg>");
  EXPECT_THROW(WritePlot{}(plot, context), std::invalid_argument);
  context.item = "clip";
  EXPECT_EQ(WritePlot{}(plot, context).path, "plots/clip.svg");
}

TEST_F(Report, WritesTracks) {
  Track track;
  track.values.resize(2, 2);
  track.values << 0.1, 2, 1.0 / 3, -4;
  Track named = track;
  named.names = {"jaw", "lips"};
  EXPECT_EQ(WriteTrack{}(track, nullptr, context).path, "tracks/track.csv");
  EXPECT_EQ(read("tracks/track.csv"), "d0,d1\n0.1,2\n0.3333333333333333,-4\n");
  context.item = "s1";
  WriteTrack{"out"}(track, &named, context);
  EXPECT_EQ(read("out/s1.csv").substr(0, 9), "jaw,lips\n");
  named.names.pop_back();
  WriteTrack{"out"}(track, &named, context);
  EXPECT_EQ(read("out/s1.csv").substr(0, 6), "d0,d1\n");
  track.values.resize(0, 2);
  WriteTrack{}(track, nullptr, context);
  EXPECT_EQ(read("tracks/s1.csv"), "d0,d1\n");
}

TEST_F(Report, SaysWhichFileCannotBeWritten) {
  context.folder = folder.write("in_the_way", "x");
  try {
    WriteTable{"t"}(table, context);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("in_the_way: this folder cannot be made"));
  }
}

}  // namespace
}  // namespace talkgraph
