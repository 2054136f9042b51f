#include "nodes/write/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "nodes/phones/label_files.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

const PhoneTrack kPhones{{{"sil", 0, 0.1278}, {"hh", 0.1278, 0.19}, {"ay", 0.19, 1.0 / 3}}};

class WritesLabels : public testing::Test {
 protected:
  void SetUp() override {
    context.folder = folder.path();
    context.item = "clip1";
  }
  std::string complaint(const PhoneTrack& phones, LabelFormat format) {
    try {
      WriteLabels{format}(phones, nullptr, context);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "none";
  }
  static void expect_equal(const std::vector<Interval>& a, const std::vector<Interval>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].label, b[i].label);
      EXPECT_NEAR(a[i].start, b[i].start, 1e-7);
      EXPECT_NEAR(a[i].end, b[i].end, 1e-7);
    }
  }

  const test::TemporaryFolder folder;
  Context context;
};

TEST_F(WritesLabels, WhatIsReadBack) {
  EXPECT_EQ(WriteLabels{}(kPhones, nullptr, context).path, "labels/clip1.TextGrid");
  expect_equal(parse_text_grid(folder.read("labels/clip1.TextGrid"), "x").at(0).intervals, kPhones.phones);
  EXPECT_EQ((WriteLabels{LabelFormat::htk, "lab"}(kPhones, nullptr, context).path), "lab/clip1.lab");
  EXPECT_EQ(folder.read("lab/clip1.lab"), "0 1278000 sil\n1278000 1900000 hh\n1900000 3333333 ay\n");
  expect_equal(parse_htk_labels(folder.read("lab/clip1.lab"), "x"), kPhones.phones);
  const PhoneTrack odd{{{"a,b", 0, 0.5}, {"say \"x\"", 0.5, 3000.1234567}}};
  WriteLabels{LabelFormat::csv}(odd, nullptr, context);
  EXPECT_EQ(folder.read("labels/clip1.csv"), "start,end,label\n0,0.5,\"a,b\"\n0.5,3000.12346,\"say \"\"x\"\"\"\n");
  EXPECT_EQ(parse_csv_labels(folder.read("labels/clip1.csv"), "x").at(1).label, "say \"x\"");
}

TEST_F(WritesLabels, WordsAsASecondTier) {
  const WordTrack words{{{"hi", 0.1278, 1.0 / 3}}};
  WriteLabels{}(kPhones, &words, context);
  const auto tiers = parse_text_grid(folder.read("labels/clip1.TextGrid"), "x");
  ASSERT_EQ(tiers.size(), 2u);
  EXPECT_EQ(tiers[1].name, "words");
  EXPECT_EQ(tiers[1].intervals.back().label, "hi");
}

TEST_F(WritesLabels, NothingAsWell) {
  for (const auto format : {LabelFormat::htk, LabelFormat::textgrid, LabelFormat::csv})
    EXPECT_EQ(complaint({}, format), "none");
  EXPECT_EQ(folder.read("labels/clip1.lab"), "");
}

TEST_F(WritesLabels, OnlyWhatTheFormatCanSay) {
  for (const auto format : {LabelFormat::htk, LabelFormat::textgrid, LabelFormat::csv}) {
    EXPECT_THAT(complaint({{{"a", 0, NAN}}}, format), HasSubstr("not in order"));
    EXPECT_THAT(complaint({{{"a", NAN, 1}}}, format), HasSubstr("not in order"));
    EXPECT_THAT(complaint({{{"a", 0, 1}, {"b", 0.5, 2}}}, format), HasSubstr("\"b\" from 0.5 s to 2 s"));
  }
  EXPECT_THAT(complaint({{{"a b", 0, 1}}}, LabelFormat::htk), HasSubstr("one word a label, not \"a b\""));
  EXPECT_THAT(complaint({{{"", 0, 1}}}, LabelFormat::htk), HasSubstr("one word"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "labels"));
  context.folder = "/dev/null/x";
  EXPECT_THAT(complaint(kPhones, LabelFormat::csv), HasSubstr("/dev/null/x"));
}

}  // namespace
}  // namespace talkgraph
