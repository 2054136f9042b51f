// What simulated people were made to answer is found again.
#include "tests/study/drawn_answers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "nodes/statistics/intervals.h"
#include "study/findings.h"
#include "study/tables.h"

namespace talkgraph::study {
namespace {

using Kind = Comparison::Kind;

const Study& full() {
  static const Study study = test::full_study();
  return study;
}

/// Of many studies the share in which something holds.
template <class Holds>
double share_of_studies(const test::Behaviour& behaviour, int studies, const Holds& holds) {
  Random random(11);
  int n = 0;
  for (int i = 0; i < studies; ++i) n += holds(find(full(), test::simulate(full(), behaviour, 30, random)));
  return n / static_cast<double>(studies);
}

TEST(DrawnAnswers, FullStudyIsThePublishedOne) {
  EXPECT_EQ(clips_shown(full().tests[0]), 16u);
  EXPECT_EQ(clips_shown(full().tests[1]), 24u);
  EXPECT_EQ(clips_shown(full().tests[2]), 12u);
  Random random(1);
  const Answers answers = test::simulate(full(), {.mean = test::published_mean}, 50, random);
  EXPECT_EQ(answers.answers.size(), 50u * (16 + 3 * 24 + 12));
  EXPECT_EQ(find(full(), answers).finished, 50u);
}

TEST(DrawnAnswers, IntervalsOfConfusionsHoldTheTruth) {
  // 38 and 45 % of synthetic, 30 and 27 % of real clips.
  double held = 0;
  const double studies = 60;
  share_of_studies({.mean = test::published_mean}, 60, [&](const Findings& findings) {
    const Table table = confusions(findings.measures[0], 0.95);
    EXPECT_EQ(table.rows.back(), "all speakers");
    const std::array<std::array<double, 2>, 2> truth = {{{0.38, 0.30}, {0.45, 0.27}}};
    for (std::size_t row = 0; row < 2; ++row)
      for (std::size_t side = 0; side < 2; ++side) {
        const auto* cells = table.cells[row].data() + 4 * side;
        held += cells[1] <= truth[row][side] && truth[row][side] <= cells[2];
      }
    return true;
  });
  EXPECT_GT(held / (4 * studies), 0.91);
  EXPECT_LT(held / (4 * studies), 0.99);
}

TEST(DrawnAnswers, MeansComeBack) {
  Random random(3);
  const Findings findings = find(full(), test::simulate(full(), {.mean = test::published_mean}, 400, random));
  for (const auto& c : findings.comparisons) {
    const Measure& measure = findings.measures[c.measure];
    if (c.kind != Kind::clips || measure.is_share() || c.of == "all clips") continue;
    const auto clip = [&](bool synthetic) {
      return *std::find_if(measure.test->clips.begin(), measure.test->clips.end(), [&](const Clip& clip) {
        return clip.synthetic == synthetic && clip.speaker + ", " + clip.eyes + " eyes" == c.of;
      });
    };
    // A scale ends at 5: means near it come out a little lower.
    EXPECT_NEAR(mean_of(values_of(c.first)), test::published_mean(*measure.test, *measure.question, clip(false), true),
                0.12);
    EXPECT_NEAR(mean_of(values_of(c.second)), test::published_mean(*measure.test, *measure.question, clip(true), true),
                0.12);
  }
  for (const auto& c : findings.comparisons)
    if (c.kind == Kind::groups && c.of == "LIPS, real") {
      EXPECT_NEAR(mean_of(values_of(c.first)), 0.878, 0.05);
      EXPECT_NEAR(mean_of(values_of(c.second)), 0.685, 0.05);
      EXPECT_LT(c.p_corrected, 0.001);
    }
}

TEST(DrawnAnswers, TestsFindWhatIsThere) {
  const double power = share_of_studies({.mean = test::published_mean}, 40, [](const Findings& findings) {
    return std::any_of(findings.comparisons.begin(), findings.comparisons.end(), [&](const Comparison& c) {
      return c.measure == 0 && c.kind == Kind::clips && c.of == "all clips" && findings.differs(c);
    });
  });
  EXPECT_GT(power, 0.95) << "72 % against 42 % taken for real, 8 clips each of 30 people";
}

TEST(DrawnAnswers, TestsSeldomFindWhatIsNot) {
  const auto alike = [](const study::Test& test, const Question&, const Clip&, bool) {
    return test.kind == TestKind::perceptual ? 3.5 : 0.6;
  };
  const double found = share_of_studies({.mean = alike}, 100, [](const Findings& findings) {
    return std::any_of(findings.comparisons.begin(), findings.comparisons.end(), [&](const Comparison& c) {
      return c.kind == Kind::clips && findings.measures[c.measure].test->kind == TestKind::perceptual &&
             findings.differs(c);
    });
  });
  EXPECT_LE(found, 0.1) << "Holm's correction bounds it by 0.05, over 15 comparisons";
}

}  // namespace
}  // namespace talkgraph::study
