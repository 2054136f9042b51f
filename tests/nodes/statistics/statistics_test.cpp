// Reference values: reference.py beside this file, by scipy 1.10.
#include <gtest/gtest.h>

#include <cmath>

#include "nodes/statistics/correction.h"
#include "nodes/statistics/intervals.h"
#include "nodes/statistics/signed_rank.h"

namespace talkgraph {
namespace {

constexpr double kTolerance = 1e-10;
const std::vector<double> kPlain = {12.5, 11.0, 14.25, 9.75, 13.0, 12.0};

TEST(SignedRank, IsExactForFewPairs) {
  SignedRank test = signed_rank({0.5, -1.25, 2.0, 3.5, -0.75, 4.25, 1.0, 2.75, -3.0, 5.5});
  EXPECT_EQ(test.statistic, 13);
  EXPECT_NEAR(test.p, 0.16015625, kTolerance);
  EXPECT_TRUE(test.exact);
  EXPECT_NEAR(test.effect, (42.0 - 13) / 55, kTolerance);
  test = signed_rank({5, 4, -3, 6, 7.5, 8, 9.25, 10});
  EXPECT_EQ(test.statistic, 1);
  EXPECT_NEAR(test.p, 0.015625, kTolerance);
}

TEST(SignedRank, CountsAllSignsWhereSizesAreEqual) {
  const SignedRank test = signed_rank({1, 1, -1, 2, 2, -2, 3, 3, -4, 5, 5, 5});
  EXPECT_EQ(test.statistic, 16);
  EXPECT_NEAR(test.p, 0.072265625, kTolerance);
}

// Shares of counts: 1/20, -1/20, 1/20 and 4/20, but for rounding.
TEST(SignedRank, TakesSizesThatDifferByRoundingForEqual) {
  const SignedRank test = signed_rank({0.1 - 0.05, 0.25 - 0.3, 0.45 - 0.4, 0.8 - 0.6});
  EXPECT_EQ(test.statistic, 2);
  EXPECT_EQ(test.p, 0.5);
}

TEST(SignedRank, IsNormalWithTiesForMany) {
  std::vector<double> many;
  for (int i = 0; i < 60; ++i) many.push_back(((37 * i) % 101 - 40) / 8.0);
  const SignedRank test = signed_rank(many);
  EXPECT_FALSE(test.exact);
  EXPECT_EQ(test.pairs, 59U) << "one is 0";
  EXPECT_EQ(test.statistic, 583);
  EXPECT_NEAR(test.p, 0.02263320893600752, kTolerance);
  EXPECT_NEAR(signed_rank(many, 59).p, test.p, 1e-3) << "exact, it is nearly the same";
}

TEST(SignedRank, LeavesOutPairsThatDoNotDiffer) {
  const SignedRank without = signed_rank({1, 2, -3}), with = signed_rank({1, 0, 2, -3, 0});
  EXPECT_EQ(with.pairs, 3U);
  EXPECT_EQ(with.p, without.p);
  for (const SignedRank& none : {signed_rank({}), signed_rank({0, 0})}) {
    EXPECT_EQ(none.pairs, 0U);
    EXPECT_EQ(none.p, 1);
    EXPECT_EQ(none.effect, 0);
  }
  EXPECT_THROW(signed_rank({1, NAN}), std::invalid_argument);
}

TEST(SignedRank, OfOneSideHasTheSmallestP) {
  std::vector<double> rising;
  for (int i = 1; i <= 30; ++i) rising.push_back(i);
  EXPECT_NEAR(signed_rank(rising).p, std::pow(2, -29), 1e-20);
  EXPECT_EQ(signed_rank(rising).effect, 1);
}

TEST(Corrected, HolmAndBenjaminiHochberg) {
  const std::vector<double> p = {0.04, 0.001, NAN, 0.2, 0.013, 0.013, 0.9};
  const std::vector<double> holm = {0.12, 0.006, NAN, 0.4, 0.065, 0.065, 0.9},
                            hochberg = {0.06, 0.006, NAN, 0.24, 0.026, 0.026, 0.9};
  const auto by_holm = corrected(p, Correction::holm), by_hochberg = corrected(p, Correction::benjamini_hochberg);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i == 2) continue;
    EXPECT_NEAR(by_holm[i], holm[i], kTolerance) << i;
    EXPECT_NEAR(by_hochberg[i], hochberg[i], kTolerance) << i;
    EXPECT_EQ(corrected(p, Correction::none)[i], p[i]);
  }
  EXPECT_TRUE(std::isnan(by_holm[2]) && std::isnan(by_hochberg[2])) << "no test is none of the tests";
  EXPECT_TRUE(corrected({}, Correction::holm).empty());
  EXPECT_EQ(corrected({0.6, 0.7}, Correction::holm), (std::vector<double>{1, 1}));
}

TEST(StudentInterval, OfTheMean) {
  const auto [low, high] = student_interval(kPlain, 0.95);
  EXPECT_NEAR(low, 10.435129037652647, kTolerance);
  EXPECT_NEAR(high, 13.731537629014023, kTolerance);
  EXPECT_NEAR(student_interval(kPlain, 0.99).low, 9.498006037324723, kTolerance);
  EXPECT_NEAR(mean_of(kPlain), 12.083333333333334, kTolerance);
  EXPECT_NEAR(deviation_of(kPlain), 1.5705625319186329, kTolerance);
}

TEST(Quantile, LiesBetweenItsNeighbours) {
  const std::vector<double> values = {1, 2, 4, 8};
  EXPECT_EQ(quantile_of(values, 0), 1);
  EXPECT_EQ(quantile_of(values, 0.5), 3);
  EXPECT_EQ(quantile_of(values, 0.75), 5);
  EXPECT_EQ(quantile_of(values, 1), 8);
  EXPECT_TRUE(std::isnan(quantile_of({}, 0.5)));
}

TEST(Intervals, SayNothingOfOneValue) {
  Random random(1);
  for (const std::vector<double>& few : {std::vector<double>{}, {3}}) {
    EXPECT_TRUE(std::isnan(student_interval(few, 0.95).low));
    EXPECT_TRUE(std::isnan(bootstrap_interval(few, 0.95, 100, random).high));
    EXPECT_TRUE(std::isnan(deviation_of(few)));
  }
  const auto [low, high] = student_interval({2, 2, 2}, 0.95);
  EXPECT_EQ(low, 2);
  EXPECT_EQ(high, 2);
}

TEST(BootstrapInterval, HasTheQuantilesOfTheMeansOfDraws) {
  Random random(1);
  // The mean of two draws of {0, 1} is 0, ½ or 1 with probabilities ¼, ½, ¼.
  const auto wide = bootstrap_interval({0, 1}, 0.6, 10000, random),
             narrow = bootstrap_interval({0, 1}, 0.4, 10000, random);
  EXPECT_EQ(wide.low, 0);
  EXPECT_EQ(wide.high, 1);
  EXPECT_EQ(narrow.low, 0.5);
  EXPECT_EQ(narrow.high, 0.5);
  // The mean of many is normal with the deviation of the n values, not n − 1, over √n.
  std::vector<double> many;
  for (int i = 0; i < 400; ++i) many.push_back(random.normal());
  const double half = 1.959964 * deviation_of(many) * std::sqrt(399.0 / 400) / 20;
  const auto [low, high] = bootstrap_interval(many, 0.95, 20000, random);
  EXPECT_NEAR(low, mean_of(many) - half, 0.04 * half);
  EXPECT_NEAR(high, mean_of(many) + half, 0.04 * half);
}

}  // namespace
}  // namespace talkgraph
