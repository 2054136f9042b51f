#include "nodes/smooth/emphasise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace talkgraph {
namespace {

Track tone(double hz, double offset) {
  Track t;
  t.values.resize(400, 1);
  for (int i = 0; i < 400; ++i) t.values(i, 0) = offset + std::cos(2 * std::numbers::pi * hz * i / 25);
  return t;
}

/// What smooth.lowpass lets through: 1 / (1 + (tan(πf/r) / tan(πc/r))⁴).
double slow(double hz, double cutoff) {
  const double ratio = std::tan(std::numbers::pi * hz / 25) / std::tan(std::numbers::pi * cutoff / 25);
  return 1 / (1 + std::pow(ratio, 4));
}

TEST(Emphasise, MultipliesWhatIsFasterAndKeepsTheRest) {
  for (const double hz : {0.1, 1.0, 4.0}) {
    const Track out = Emphasise{.cutoff = 1, .gain = 1.5}(tone(hz, 7));
    const double gain = slow(hz, 1) + 1.5 * (1 - slow(hz, 1));
    for (int i = 150; i < 250; ++i) EXPECT_NEAR(out.values(i, 0), 7 + gain * (tone(hz, 0).values(i, 0)), 1e-4) << hz;
  }
}

TEST(Emphasise, AGainOfOneDoesNothing) {
  const Track in = tone(3, 1);
  EXPECT_LT((Emphasise{.gain = 1}(in).values - in.values).norm(), 1e-12);
  EXPECT_EQ(Emphasise{}(Track{}).values.rows(), 0);
}

TEST(Emphasise, RefusesNaN) {
  Track in = tone(3, 1);
  in.values(5, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Emphasise{}(in), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
