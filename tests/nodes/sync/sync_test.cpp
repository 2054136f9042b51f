#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nodes/sync/median.h"
#include "nodes/sync/polyphase.h"

namespace talkgraph {
namespace {

const Rational ntsc{30000, 1001};

Track tone(double hz, int frames = 300) {
  Track t;
  t.rate = Rational(100);
  t.start = 0.0125;
  t.values.resize(frames, 1);
  for (int i = 0; i < frames; ++i) t.values(i, 0) = std::sin(2 * std::numbers::pi * hz * t.time(i));
  return t;
}

Audio seconds(double s) {
  Audio a;
  a.samples = Eigen::VectorXd::Zero(std::lround(s * a.rate));
  return a;
}

TEST(Sync, GivesTheFramesOfTheVideo) {
  const Audio audio = seconds(2.98);
  for (const Rational rate : {Rational(25), ntsc, Rational(50)}) {
    const auto expected = std::lround(2.98 * rate.value());
    EXPECT_EQ((Polyphase{.rate = rate}(tone(1), &audio).frames()), expected);
    EXPECT_EQ(MedianSync{rate}(tone(1), &audio).frames(), expected);
    EXPECT_DOUBLE_EQ(MedianSync{rate}(tone(1), &audio).start, 0.5 / rate.value());
  }
  const Audio click = seconds(0.001);
  EXPECT_EQ(Polyphase{}(tone(1, 1), &click).frames(), 1);
}

TEST(Polyphase, KeepsAConstantAndASlowToneWithoutDelay) {
  Track constant = tone(1);
  constant.values.setConstant(3.5);
  EXPECT_LT((Polyphase{.rate = ntsc}(constant, nullptr).values.array() - 3.5).abs().maxCoeff(), 1e-12);
  const Track slow = Polyphase{.rate = ntsc}(tone(4), nullptr);
  for (Eigen::Index n = 20; n < slow.frames() - 20; ++n)
    EXPECT_NEAR(slow.values(n, 0), std::sin(2 * std::numbers::pi * 4 * slow.time(n)), 0.01);
}

TEST(Polyphase, SuppressesAliasesBy40dB) {
  for (const double hz : {17.0, 22.0, 33.0, 45.0}) {
    const Track t = Polyphase{}(tone(hz), nullptr);
    EXPECT_LT(t.values.middleRows(10, t.frames() - 20).cwiseAbs().maxCoeff(), 0.01) << hz;
  }
}

TEST(Median, TakesTheMiddleOfEachVideoFrame) {
  Track t;
  t.rate = Rational(100);
  t.start = 0.005;  // centres 5, 15, 25, 35 ms lie in the first frame of 40 ms
  t.values.resize(8, 1);
  t.values << 1, 9, 2, 3, 10, 10, 10, 50;
  const Track m = MedianSync{}(t, nullptr);
  ASSERT_EQ(m.frames(), 2);
  EXPECT_EQ(m.values(0, 0), 2.5);
  EXPECT_EQ(m.values(1, 0), 10);
}

TEST(Median, TakesTheNearestWhereAFrameIsEmpty) {
  Track t;
  t.rate = Rational(10);
  t.start = 0.05;
  t.values = Eigen::Vector2d(1, 2);
  const Track m = MedianSync{}(t, nullptr);
  ASSERT_EQ(m.frames(), 5);
  EXPECT_EQ(m.values(0, 0), 1);
  EXPECT_EQ(m.values(4, 0), 2);
}

TEST(Sync, RefusesEmptyAndBrokenTracks) {
  Track t;
  EXPECT_THROW(Polyphase{}(t, nullptr), std::runtime_error);
  EXPECT_THROW(MedianSync{}(t, nullptr), std::runtime_error);
  t = tone(1);
  t.values(3, 0) = NAN;
  EXPECT_THROW(Polyphase{}(t, nullptr), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
