#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "nodes/write/table.h"
#include "nodes/write/track.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class WriteText : public testing::Test {
 protected:
  void SetUp() override { context.folder = folder.path(); }
  std::string read(const std::string& name) const { return folder.read(name); }

  const test::TemporaryFolder folder;
  Context context;
  Table table{"scores", "method", {"acc", "n"}, {"a, \"b\"", "c"}, {{0.5, 3}, {NAN, 4}}};
};

TEST_F(WriteText, TablesAreCsvAndJson) {
  EXPECT_EQ((WriteTable{"t"}(table, context)).path, "t.csv");
  EXPECT_EQ(read("t.csv"), "method,acc,n\n\"a, \"\"b\"\"\",0.5,3\nc,,4\n");
  const Json json = Json::parse(read("t.json"));
  EXPECT_EQ(json["rows"]["c"]["n"], 4);
  EXPECT_TRUE(json["rows"]["c"]["acc"].is_null());
}

TEST_F(WriteText, TablesOfAStreamGoBelowTheName) {
  context.item = "s1/a";
  EXPECT_EQ((WriteTable{"t"}(table, context)).path, "t/s1/a.csv");
  EXPECT_EQ(Json::parse(read("t/s1/a.json"))["title"], "scores");
}

TEST_F(WriteText, TablesMayBeEmptyButNotAmbiguous) {
  WriteTable{"t"}({}, context);
  EXPECT_EQ(read("t.csv"), "\n");
  EXPECT_TRUE(Json::parse(read("t.json"))["rows"].empty());
  table.rows[1] = table.rows[0] = "ours";
  try {
    WriteTable{"twice"}(table, context);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("two rows called \"ours\""));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "twice.json"));
}

TEST_F(WriteText, Tracks) {
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

TEST_F(WriteText, TracksSayWhatIsNoNumber) {
  Track track;
  track.values = Eigen::RowVector3d(NAN, INFINITY, 1e-300);
  WriteTrack{}(track, nullptr, context);
  EXPECT_EQ(read("tracks/track.csv"), "d0,d1,d2\nnan,inf,1e-300\n");
}

TEST_F(WriteText, StaysBelowTheRunFolder) {
  context.folder = folder.path() / "run/below";
  const auto complaint = [&](const std::string& below, const std::string& item) {
    context.item = item;
    try {
      WriteTrack{below}(Track{}, nullptr, context);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(complaint("../out", "a"), HasSubstr("\"../out/a.csv\" is not below the run folder"));
  EXPECT_THAT(complaint("x/../../../out", "a"), HasSubstr("is not below the run folder"));
  EXPECT_THAT(complaint(folder.file("out"), "a"), HasSubstr("out/a.csv\" is not below the run folder"));
  EXPECT_THAT(complaint("out", "../../a"), HasSubstr("is not below the run folder"));
  EXPECT_THAT(complaint("out", "/a"), HasSubstr("\"/a.csv\" is not below the run folder"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(complaint("..out", "a..b"), "none");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "run/below/..out/a..b.csv"));
}

TEST_F(WriteText, SaysWhichFileCannotBeWritten) {
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
