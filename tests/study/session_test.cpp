#include "study/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/study/small_study.h"

namespace talkgraph::study {
namespace {

std::vector<std::string> ids(const std::vector<Showing>& all) {
  std::vector<std::string> names;
  for (const auto& shown : all) names.push_back(shown.clip->id);
  return names;
}

TEST(Plan, DrawsSoManyOfEachCategory) {
  const auto study = small_study();
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::map<std::pair<std::string, std::string>, int> counts;
    std::set<std::string> clips;
    for (const auto& shown : plan(study, seed)) {
      ++counts[{shown.test->id, shown.clip->category()}];
      clips.insert(shown.clip->id);
    }
    for (const auto& [category, count] : counts) EXPECT_EQ(count, 2) << category.second;
    EXPECT_EQ(counts.size(), 8u);
    EXPECT_EQ(clips.size(), 16u) << "each clip once";
  }
}

TEST(Plan, CountsPositionsOfEachTestFromNought) {
  const auto study = small_study();
  const auto all = plan(study, 3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool first = i == 0 || all[i].test != all[i - 1].test;
    EXPECT_EQ(all[i].position, first ? 0 : all[i - 1].position + 1);
  }
}

TEST(Plan, IsThatOfItsSeed) {
  const auto study = small_study();
  EXPECT_EQ(ids(plan(study, 7)), ids(plan(study, 7)));
  EXPECT_NE(ids(plan(study, 7)), ids(plan(study, 8)));
}

TEST(Plan, AnyTestAndAnyClipMayComeFirst) {
  const auto study = small_study();
  std::map<std::string, int> tests, clips;
  const int people = 3000;
  for (std::uint64_t seed = 0; seed < people; ++seed) {
    const auto all = plan(study, seed);
    ++tests[all[0].test->id];
    if (all[0].test->id == "turing") ++clips[all[0].clip->id];
  }
  ASSERT_EQ(tests.size(), 3u);
  for (const auto& [id, count] : tests) EXPECT_NEAR(count, people / 3, 130) << id;
  ASSERT_EQ(clips.size(), 6u);
  for (const auto& [id, count] : clips) EXPECT_NEAR(count, people / 18, 60) << id;
}

TEST(Plan, ShowsAllWhereThereAreFewer) {
  auto study = small_study();
  study.tests.resize(1);
  study.tests[0].per_category = 100;
  EXPECT_EQ(plan(study, 1).size(), study.tests[0].clips.size());
}

TEST(Options, AreTheClipsWhereTheQuestionHasNone) {
  Clip clip;
  clip.choices = {"one", "two"};
  EXPECT_EQ(options({"q", "?", {}}, clip).size(), 2u);
  EXPECT_EQ(options({"q", "?", {"a", "b", "c"}}, clip).size(), 3u);
}

}  // namespace
}  // namespace talkgraph::study
