#include "nodes/phones/visemes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "nodes/phones/mark_pauses.h"
#include "nodes/phones/mouth_shapes.h"
#include "nodes/types/visemes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

TEST(Visemes, CoverCmuAndBeepInFourteenClasses) {
  std::set<int> classes;
  std::set<std::string_view> phones;
  for (const auto& entry : kVisemes) {
    classes.insert(entry.viseme);
    EXPECT_TRUE(phones.insert(entry.phone).second) << entry.phone;
  }
  EXPECT_EQ(classes.size(), 14u);
  EXPECT_EQ(phones.size(), 44u);  // the BEEP set, which contains the 39 of CMU
  EXPECT_EQ(viseme("p"), viseme("m"));
  EXPECT_EQ(viseme("ua"), 14);
  EXPECT_EQ(viseme("sil"), 0);
  EXPECT_EQ(viseme("lead_breath"), 0);
  EXPECT_FALSE(viseme("AA"));
}

std::vector<std::string> marked(const std::vector<std::string>& labels) { return MarkPauses{}({labels, 30}).labels; }

TEST(MarkPauses, NamesThoseAtTheEndsOnly) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(marked({"sil", "breath", "aa", "sil", "b", "sil"}),
            (Labels{"lead_sil", "lead_breath", "aa", "sil", "b", "trail_sil"}));
  EXPECT_EQ(marked({"aa"}), Labels{"aa"});
  EXPECT_EQ(marked({"sil", "sil"}), (Labels{"lead_sil", "lead_sil"}));
  EXPECT_EQ(marked({}), Labels{});
  EXPECT_EQ(MarkPauses{}({{"sil"}, 30}).rate, Rational(30));
}

TEST(ToVisemes, KeepsTimes) {
  const auto visemes = ToVisemes{}({{{"sil", 0, 0.1}, {"m", 0.1, 0.2}}}).phones;
  EXPECT_EQ(visemes[0].label, "sil");
  EXPECT_EQ(visemes[1].label, "1");
  EXPECT_EQ(visemes[1].start, 0.1);
}

std::string shapes(const PhoneTrack& phones) {
  std::string text;
  for (const auto& cue : mouth_shapes(phones)) text += std::to_string(std::lround(cue.start * 100)) + cue.label + " ";
  return text;
}

TEST(MouthShapes, EveryPhoneHasOne) {
  for (const auto& entry : kVisemes)
    EXPECT_EQ(mouth_shapes({{{std::string(entry.phone), 0, 0.4}}}).back().end, 0.4) << entry.phone;
  EXPECT_THROW(mouth_shapes({{{"qq", 0, 0.4}}}), std::runtime_error);
  EXPECT_TRUE(mouth_shapes({}).empty());
}

TEST(MouthShapes, StopsCloseBeforeTheirBurst) {
  // Half of the 200 ms vowel before the "p"; what follows is free and stays closed.
  EXPECT_EQ(shapes({{{"sil", 0, 0.5}, {"aa", 0.5, 0.7}, {"p", 0.7, 0.76}, {"iy", 0.76, 0.9}}}), "0X 50D 60A 76B ");
}

TEST(MouthShapes, DiphthongsGlideAfterSixtyPercent) { EXPECT_EQ(shapes({{{"ow", 0, 0.5}}}), "0E 30F "); }

TEST(MouthShapes, BriefVowelsOpenLess) {
  EXPECT_EQ(shapes({{{"ah", 0, 0.1}}}), "0C ");
  EXPECT_EQ(shapes({{{"ah", 0, 0.3}}}), "0D ");
}

TEST(MouthShapes, FreePhonesStayNearTheShapeBefore) {
  EXPECT_EQ(shapes({{{"uw", 0, 0.2}, {"s", 0.2, 0.3}}}), "0F ");
  EXPECT_EQ(shapes({{{"iy", 0, 0.2}, {"s", 0.2, 0.3}}}), "0B ");
}

TEST(MouthShapes, ShortPausesAreNotIdle) {
  EXPECT_EQ(shapes({{{"aa", 0, 0.2}, {"sil", 0.2, 0.3}, {"aa", 0.3, 0.5}}}), "0D 20B 30D ");
  EXPECT_EQ(shapes({{{"aa", 0, 0.2}, {"sil", 0.2, 0.6}, {"aa", 0.6, 0.8}}}), "0D 20X 60D ");
}

}  // namespace
}  // namespace talkgraph
