// Reference values: reference.py beside this file, by scipy 1.10.
#include "nodes/statistics/rank_sum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/statistics/intervals.h"
#include "nodes/statistics/proportions.h"

namespace talkgraph {
namespace {

constexpr double kTolerance = 1e-10;
const std::vector<double> kUntiedA = {0.8, 1.7, 2.9, 3.1, 4.6, 5.2, 7.7}, kUntiedB = {0.3, 1.1, 1.9, 2.2, 2.4, 3.9};
const std::vector<double> kScoresA = {4, 5, 4, 3, 5, 4, 4, 5}, kScoresB = {3, 4, 2, 3, 3, 4, 5, 2, 3};

std::vector<double> made(int n, double (*value)(int)) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(value(i));
  return values;
}

TEST(RankSum, IsExactForFewValues) {
  const RankSum test = rank_sum(kUntiedA, kUntiedB);
  EXPECT_TRUE(test.exact);
  EXPECT_EQ(test.statistic, 31);
  EXPECT_NEAR(test.p, 0.18065268065268064, kTolerance);
  EXPECT_NEAR(test.effect, 2 * 31 / 42.0 - 1, kTolerance);
  EXPECT_NEAR(test.superiority(), 31 / 42.0, kTolerance);
}

TEST(RankSum, CountsAllChoicesWhereValuesAreEqual) {
  const RankSum test = rank_sum(kScoresA, kScoresB);
  EXPECT_TRUE(test.exact);
  EXPECT_EQ(test.statistic, 57.5);
  EXPECT_NEAR(test.p, 0.039901275195392841, kTolerance);
}

TEST(RankSum, IsNormalWithTiesAndContinuityForMany) {
  RankSum test = rank_sum(kUntiedA, kUntiedB, 12);
  EXPECT_FALSE(test.exact);
  EXPECT_NEAR(test.p, 0.17473582321524717, kTolerance);
  EXPECT_NEAR(rank_sum(kScoresA, kScoresB, 0).p, 0.035051457793953529, kTolerance);
  test = rank_sum(made(50, [](int i) { return (7 * i * i) % 4 / 3.0; }),
                  made(47, [](int i) { return (5 * i + i / 7) % 4 / 3.0; }));
  EXPECT_EQ(test.statistic, 1262.5);
  EXPECT_NEAR(test.p, 0.50665784008034931, kTolerance);
}

TEST(RankSum, CountsChoicesOfManyAsWell) {
  const auto a = made(40, [](int i) { return ((37 * i) % 101) / 8.0; }),
             b = made(45, [](int i) { return ((53 * i) % 97) / 8.0 + 0.01; });
  EXPECT_NEAR(rank_sum(a, b, 85).p, 0.51380711613733121, kTolerance);
  EXPECT_NEAR(rank_sum(a, b).p, 0.51186535201271344, kTolerance);
  EXPECT_EQ(rank_sum(a, b).statistic, 975);
}

TEST(RankSum, IsTheSameTheOtherWayRound) {
  for (const std::size_t exact_up_to : {0, 50}) {
    const RankSum test = rank_sum(kScoresA, kScoresB, exact_up_to), other = rank_sum(kScoresB, kScoresA, exact_up_to);
    EXPECT_NEAR(test.p, other.p, 1e-14);
    EXPECT_NEAR(test.effect, -other.effect, 1e-14);
  }
}

TEST(RankSum, OfSeparateSamplesHasTheSmallestP) {
  const RankSum test = rank_sum({4, 5, 6}, {1, 2, 3});
  EXPECT_EQ(test.effect, 1);
  EXPECT_NEAR(test.p, 2 / 20.0, 1e-14) << "of 20 ways to choose 3 of 6 one is as high, one as low";
}

TEST(RankSum, OfHardlyAnythingFindsNothing) {
  EXPECT_EQ(rank_sum({1}, {2}).p, 1);
  EXPECT_EQ(rank_sum({1}, {2}).effect, -1);
  for (const std::size_t exact_up_to : {0, 50}) {
    const RankSum equal = rank_sum({3, 3, 3}, {3, 3}, exact_up_to);
    EXPECT_EQ(equal.p, 1);
    EXPECT_EQ(equal.effect, 0);
    EXPECT_EQ(equal.superiority(), 0.5);
  }
  EXPECT_EQ(rank_sum({1, 4}, {2, 3}, 0).p, 1) << "not above 1, by the continuity correction";
  EXPECT_TRUE(std::isnan(rank_sum({}, {1}).p));
  EXPECT_TRUE(std::isnan(rank_sum({1}, {}).effect));
  EXPECT_THROW(rank_sum({1, NAN}, {1}), std::invalid_argument);
  EXPECT_THROW(rank_sum({1}, {INFINITY}), std::invalid_argument);
}

TEST(WilsonInterval, OfAShare) {
  const auto expect = [](std::size_t part, std::size_t whole, double confidence, double low, double high) {
    const auto interval = wilson_interval(part, whole, confidence);
    EXPECT_NEAR(interval.low, low, kTolerance) << part << " of " << whole;
    EXPECT_NEAR(interval.high, high, kTolerance) << part << " of " << whole;
  };
  expect(38, 100, 0.95, 0.2909759925247874, 0.47790244704488921);
  expect(7, 16, 0.99, 0.18661357439928483, 0.72502728549712103);
  expect(0, 12, 0.95, 0, 0.24249400665524085);
  expect(12, 12, 0.95, 0.75750599334475921, 1);
  expect(1, 1, 0.9, 0.26986594878405412, 1);
  EXPECT_EQ(wilson_interval(0, 12, 0.95).low, 0);
  EXPECT_EQ(wilson_interval(12, 12, 0.95).high, 1);
  EXPECT_TRUE(std::isnan(wilson_interval(0, 0, 0.95).low));
  EXPECT_THROW(wilson_interval(2, 1, 0.95), std::invalid_argument);
}

TEST(CohensH, TellsSharesApart) {
  EXPECT_NEAR(cohens_h(0.38, 0.7), -0.65388269710645153, kTolerance);
  EXPECT_EQ(cohens_h(0.4, 0.4), 0);
  EXPECT_NEAR(cohens_h(1, 0), M_PI, kTolerance);
}

}  // namespace
}  // namespace talkgraph
