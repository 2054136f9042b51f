#include "nodes/phones/label_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/temporary_folder.h"

namespace talkgraph {

bool operator==(const Interval& a, const Interval& b) {
  return a.label == b.label && std::abs(a.start - b.start) < 1e-7 && std::abs(a.end - b.end) < 1e-7;
}
void PrintTo(const Interval& i, std::ostream* out) { *out << i.label << " " << i.start << "-" << i.end; }

namespace {

const std::vector<Interval> kPhones = {{"sil", 0, 0.1278}, {"hh", 0.1278, 0.19}, {"ay", 0.19, 1.0 / 3}};

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "no error";
}

TEST(LabelFiles, HtkTimesAreIn100Nanoseconds) {
  EXPECT_EQ(htk_labels(kPhones), "0 1278000 sil\n1278000 1900000 hh\n1900000 3333333 ay\n");
  EXPECT_EQ(parse_htk_labels(htk_labels(kPhones), "x.lab"), kPhones);
  EXPECT_EQ(parse_htk_labels("0 1000000 aa -12.5 word\n\n", "x.lab"), (std::vector<Interval>{{"aa", 0, 0.1}}));
}

TEST(LabelFiles, CsvGoesRound) {
  EXPECT_EQ(csv_labels({{"aa", 0, 0.25}}), "start,end,label\n0,0.25,aa\n");
  EXPECT_EQ(parse_csv_labels(csv_labels(kPhones), "x.csv"), kPhones);
}

TEST(LabelFiles, TextGridGoesRound) {
  const auto tiers = parse_text_grid(text_grid({{"phones", kPhones}, {"the \"words\"", {{"hi", 0.1, 0.3}}}}), "x");
  ASSERT_EQ(tiers.size(), 2u);
  EXPECT_EQ(tiers[0].name, "phones");
  EXPECT_EQ(tiers[0].intervals, kPhones);
  EXPECT_EQ(tiers[1].name, "the \"words\"");
  EXPECT_EQ(tiers[1].intervals, (std::vector<Interval>{{"sil", 0, 0.1}, {"hi", 0.1, 0.3}, {"sil", 0.3, 1.0 / 3}}));
}

TEST(LabelFiles, ReadsThePraatShortFormatAndSkipsPointTiers) {
  const auto tiers = parse_text_grid(
      "File type = \"ooTextFile\"\r\nObject class = "
      "\"TextGrid\"\r\n\r\n0\r\n1\r\n<exists>\r\n2\r\n\"TextTier\"\r\n\"beeps\"\r\n"
      "0\r\n1\r\n1\r\n0.5\r\n\"beep\"\r\n\"IntervalTier\"\r\n\"phones\"\r\n0\r\n1\r\n2\r\n0\r\n0.4\r\n\"\"\r\n0."
      "4\r\n1\r\n\"aa\"\r\n",
      "x");
  ASSERT_EQ(tiers.size(), 1u);
  EXPECT_EQ(tiers[0].intervals, (std::vector<Interval>{{"sil", 0, 0.4}, {"aa", 0.4, 1}}));
}

TEST(LabelFiles, SayWhereTheyAreWrong) {
  EXPECT_EQ(error_of([] { parse_htk_labels("0 1000 aa\n1000 x b\n", "a.lab"); }),
            "a.lab:2: \"start end label\" is expected, times in 100 ns");
  EXPECT_EQ(error_of([] { parse_htk_labels("0 1000 aa\n500 900 b\n", "a.lab"); }),
            "a.lab:2: the interval starts before the one above ends");
  EXPECT_EQ(error_of([] { parse_csv_labels("start,end,label\n2,1,aa\n", "a.csv"); }),
            "a.csv:2: the interval ends before it starts");
  EXPECT_NE(error_of([] { parse_text_grid("hello", "a.TextGrid"); }).find("a.TextGrid:1: "), std::string::npos);
  EXPECT_NE(error_of([] { parse_text_grid("ooBinaryFile\x08TextGrid", "a.TextGrid"); }).find("save it as a text file"),
            std::string::npos);
  const std::string whole = text_grid({{"phones", kPhones}});
  for (std::size_t cut : {10u, 60u, 120u, 200u, 300u})
    EXPECT_NE(error_of([&] { parse_text_grid(whole.substr(0, cut), "a.TextGrid"); }).find("expected"),
              std::string::npos)
        << cut;
}

TEST(LabelFiles, TakeEmptyTracks) {
  EXPECT_EQ(htk_labels({}), "");
  EXPECT_TRUE(parse_htk_labels("", "x").empty());
  EXPECT_EQ(parse_text_grid(text_grid({{"phones", {}}}), "x").size(), 1u);
}

}  // namespace
}  // namespace talkgraph
