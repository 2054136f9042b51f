#include <gtest/gtest.h>

#include <cmath>

#include "graph/random.h"
#include "graph/rational.h"

namespace talkgraph {
namespace {

TEST(Rational, KeepsRatiosExactly) {
  EXPECT_EQ(Rational::parse("29.97"), Rational(2997, 100));
  EXPECT_EQ(Rational::parse("30000/1001") / Rational(100), Rational(300, 1001));
  EXPECT_EQ(Rational(50, -100).str(), "-1/2");
  EXPECT_EQ(Rational::parse("25").str(), "25");
}

TEST(Rational, RefusesNonsense) {
  for (const char* text : {"", "x", "1/0", "1/", ".", "1.2.3", "1e3", "123456789.1234567890123456"})
    EXPECT_THROW(Rational::parse(text), std::invalid_argument) << text;
}

// First numbers of xoshiro256** seeded with splitmix64(1): they may never
// change, for labels and landmarks of the built-in speaker hang on them.
TEST(Random, IsTheSameEverywhere) {
  Random r(1);
  const std::uint64_t first = r.bits();
  Random again(1);
  EXPECT_EQ(again.bits(), first);
  EXPECT_EQ(first, 12966619160104079557ull);
  EXPECT_NE(Random(1, "a.b", "k").bits(), Random(1, "a.b", "l").bits());
  EXPECT_NE(Random(1, "a.b", "k").bits(), Random(2, "a.b", "k").bits());
}

TEST(Random, HasTheRightMoments) {
  Random r(3);
  double mean = 0, square = 0, normal = 0, normal_square = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double u = r.uniform(), g = r.normal();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    mean += u / n, square += u * u / n, normal += g / n, normal_square += g * g / n;
  }
  EXPECT_NEAR(mean, 0.5, 0.005);
  EXPECT_NEAR(square, 1.0 / 3, 0.005);
  EXPECT_NEAR(normal, 0, 0.02);
  EXPECT_NEAR(normal_square, 1, 0.02);
}

TEST(Random, DrawsBelowEvenly) {
  Random r(5);
  std::vector<int> counts(7);
  for (int i = 0; i < 70000; ++i) ++counts[r.below(7)];
  for (const int c : counts) EXPECT_NEAR(c, 10000, 500);
}

}  // namespace
}  // namespace talkgraph
