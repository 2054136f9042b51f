#include "nodes/smooth/lowpass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace talkgraph {
namespace {

Track tone(double hz) {
  Track t;
  t.values.resize(400, 1);
  for (int i = 0; i < 400; ++i) t.values(i, 0) = std::cos(2 * std::numbers::pi * hz * i / 25);
  return t;
}

// Gain of the bilinear Butterworth of order 2, twice: 1 / (1 + (tan(πf/r) / tan(πc/r))⁴).
double gain(double hz, double cutoff) {
  const double ratio = std::tan(std::numbers::pi * hz / 25) / std::tan(std::numbers::pi * cutoff / 25);
  return 1 / (1 + std::pow(ratio, 4));
}

TEST(Lowpass, HasTheGainOfItsDesignAndNoDelay) {
  for (const double hz : {0.5, 2.0, 5.0, 8.0, 11.0}) {
    const Track in = tone(hz), out = Lowpass{5}(in);
    const double expected = gain(hz, 5);
    for (int i = 100; i < 300; ++i) EXPECT_NEAR(out.values(i, 0), expected * in.values(i, 0), 1e-6) << hz;
  }
}

TEST(Lowpass, HalvesTheCutoff) {
  const Track in = tone(4), out = Lowpass{4}(in);
  for (int i = 100; i < 300; ++i) EXPECT_NEAR(out.values(i, 0), in.values(i, 0) / 2, 1e-6);
}

TEST(Lowpass, IsSymmetricInTime) {
  Track t;
  t.values = Eigen::MatrixXd::Random(60, 1);
  Track back = t;
  back.values = t.values.colwise().reverse();
  EXPECT_LT((Lowpass{3}(back).values.colwise().reverse() - Lowpass{3}(t).values).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Lowpass, KeepsConstantsAndLinesToTheEnds) {
  Track t;
  t.values.resize(50, 2);
  t.values.col(0).setConstant(4);
  t.values.col(1) = Eigen::VectorXd::LinSpaced(50, 0, 49);
  EXPECT_LT((Lowpass{4}(t).values - t.values).cwiseAbs().maxCoeff(), 0.05);
}

TEST(Lowpass, LeavesShortTracksAndHighCutoffsAlone) {
  Track t;
  t.values = Eigen::Vector2d(1, 5);
  EXPECT_EQ(Lowpass{2}(t).values, t.values);
  EXPECT_EQ(Lowpass{12.5}(tone(3)).values, tone(3).values);
  t.values = Eigen::Vector3d(1, NAN, 2);
  EXPECT_THROW(Lowpass{}(t), std::runtime_error);
  t.values.resize(0, 3);
  EXPECT_EQ(Lowpass{}(t).frames(), 0);
}

}  // namespace
}  // namespace talkgraph
