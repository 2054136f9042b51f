#include "experiment/verdict.h"

#include <gmock/gmock.h>

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::FieldsAre;
using testing::IsEmpty;
using testing::IsNan;

Estimate of(std::size_t setting, const char* row, const char* measure, double mean, double p = NAN) {
  Estimate e;
  e.setting = setting;
  e.row = row;
  e.measure = measure;
  e.mean = mean;
  e.p = p;
  return e;
}

std::vector<Verdict> verdicts_of(const std::vector<Estimate>& estimates) {
  std::vector<const Estimate*> all;
  for (const auto& e : estimates) all.push_back(&e);
  return verdicts(all);
}

TEST(Verdicts, NameTheBestAndWhoIsNotSignificantlyBehind) {
  const auto all = verdicts_of({of(0, "ours", "acc behind", 0), of(0, "ours", "acc won", 7),
                                of(0, "theirs", "acc behind", 0.3, 0.05), of(0, "near", "acc behind", 0.1, 0.6),
                                of(0, "far", "acc behind", 0.4, 0.049), of(0, "untested", "acc behind", 0.2)});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].score, "acc");
  EXPECT_EQ(all[0].best, "ours");
  EXPECT_EQ(all[0].won, 7);
  EXPECT_EQ(all[0].beaten, 1u);
  EXPECT_THAT(all[0].close, ElementsAre(FieldsAre("near", 0.1), FieldsAre("untested", 0.2), FieldsAre("theirs", 0.3)));
}

TEST(Verdicts, StandBySettingAndScore) {
  const auto all = verdicts_of({of(1, "a", "acc behind", 0), of(1, "b", "acc behind", 0.1, 0.01),
                                of(0, "a", "acc behind", 0), of(0, "b", "lve behind", 0),
                                of(0, "a", "lve behind", 0.5, 0.01), of(0, "b", "acc behind", 0.1, 0.2)});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].setting, 0u);
  EXPECT_EQ(all[0].score, "acc");
  EXPECT_EQ(all[0].close.size(), 1u);
  EXPECT_EQ(all[1].score, "lve");
  EXPECT_EQ(all[1].best, "b");
  EXPECT_THAT(all[1].close, IsEmpty());
  EXPECT_THAT(all[1].won, IsNan());
  EXPECT_EQ(all[2].setting, 1u);
}

TEST(Verdicts, TiesAreNotWon) {
  const auto all = verdicts_of({of(0, "a", "acc behind", 0), of(0, "b", "acc behind", 0, 1)});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].best, "a");
  EXPECT_THAT(all[0].close, ElementsAre(FieldsAre("b", 0.0)));
}

TEST(Verdicts, AreNotGivenWhereNoneIsBest) {
  EXPECT_THAT(verdicts_of({of(0, "a", "acc", 0.5)}), IsEmpty());
  EXPECT_THAT(verdicts_of({of(0, "a", "acc behind", 0.1, 0.01)}), IsEmpty()) << "as means over repeats have it";
  EXPECT_THAT(verdicts_of({of(0, "a", "acc behind", 0)}), IsEmpty()) << "there is no other";
  EXPECT_THAT(verdicts_of({of(0, "a", "acc behind", 0), of(0, "b", "acc behind", 0.4)}), IsEmpty()) << "no test";
  EXPECT_THAT(verdicts_of({}), IsEmpty());
}

}  // namespace
}  // namespace talkgraph
