#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nodes/sync/frames.h"
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
    const auto expected = static_cast<Eigen::Index>(std::ceil(2.98 * rate.value() - 1e-6));
    EXPECT_EQ((Polyphase{.rate = rate}(tone(1), &audio).frames()), expected);
    EXPECT_EQ(MedianSync{rate}(tone(1), &audio).frames(), expected);
    const Track frames = VideoFrames{rate}(audio);
    EXPECT_EQ(frames.frames(), expected);
    EXPECT_EQ(frames.dimension(), 0);
    EXPECT_DOUBLE_EQ(frames.time(7), MedianSync{rate}(tone(1), &audio).time(7));
    EXPECT_DOUBLE_EQ(MedianSync{rate}(tone(1), &audio).start, 0.5 / rate.value());
  }
  const Audio click = seconds(0.001);
  EXPECT_EQ(Polyphase{}(tone(1, 1), &click).frames(), 1);
  EXPECT_EQ(VideoFrames{}(click).frames(), 1);
}

TEST(Polyphase, KeepsAConstantAndASlowToneWithoutDelay) {
  Track constant = tone(1);
  constant.values.setConstant(3.5);
  EXPECT_LT((Polyphase{.rate = ntsc}(constant, nullptr).values.array() - 3.5).abs().maxCoeff(), 1e-12);
  const Track slow = Polyphase{.rate = ntsc}(tone(4), nullptr);
  for (Eigen::Index n = 20; n < slow.frames() - 20; ++n)
    EXPECT_NEAR(slow.values(n, 0), std::sin(2 * std::numbers::pi * 4 * slow.time(n)), 0.01);
}

// The filter written out for one output frame, from the definition.
double direct(const Track& t, double seconds, double fps, int zeros, double beta) {
  const double in = t.rate.value(), band = std::min(1.0, fps / in), extent = zeros / band;
  const double centre = (seconds - t.start) * in;
  double sum = 0, norm = 0;
  for (int i = -2000; i < 3000; ++i) {
    const double x = i - centre;
    if (std::abs(x) > extent) continue;
    const double pi = std::numbers::pi, sinc = x == 0 ? 1 : std::sin(pi * x * band) / (pi * x * band);
    const double w = sinc * std::cyl_bessel_i(0.0, beta * std::sqrt(1 - std::pow(x / extent, 2)));
    sum += w * t.values(std::clamp<int>(i, 0, static_cast<int>(t.frames()) - 1), 0);
    norm += w;
  }
  return sum / norm;
}

TEST(Polyphase, AgreesWithItsDefinitionAtEveryPhase) {
  const Track noise = [] {
    Track t = tone(1, 150);
    t.values.setRandom();
    return t;
  }();
  for (const Rational rate : {Rational(25), ntsc, Rational(24), Rational(120), Rational(100)}) {
    const Track out = Polyphase{.rate = rate}(noise, nullptr);
    for (Eigen::Index n = 0; n < out.frames(); ++n)
      ASSERT_NEAR(out.values(n, 0), direct(noise, out.time(n), rate.value(), 8, 6), 1e-12) << rate.str() << " " << n;
  }
}

TEST(Polyphase, ReachesBeyondTheTrackByRepeatingItsEnds) {
  const Track late = [] {
    Track t = tone(1, 50);
    t.start = 0.06;
    t.values.setRandom();
    return t;
  }();
  const Audio audio = seconds(0.7);
  const Track out = Polyphase{.rate = 50}(late, &audio);
  ASSERT_EQ(out.frames(), 35);
  for (Eigen::Index n = 0; n < 35; ++n) EXPECT_NEAR(out.values(n, 0), direct(late, out.time(n), 50, 8, 6), 1e-12) << n;
}

TEST(Polyphase, SharesItsPhasesWithoutDriftOverAnHour) {
  Track line;
  line.rate = Rational(100);
  line.start = 0.0125;
  line.values = Eigen::VectorXd::LinSpaced(360000, 0, 359999);
  const Track out = Polyphase{.rate = ntsc}(line, nullptr);
  EXPECT_EQ(out.frames(), std::lround((0.025 + 3599.99) * ntsc.value()));
  for (Eigen::Index n = 100; n < out.frames() - 100; n += 997)
    EXPECT_NEAR(out.values(n, 0), (out.time(n) - 0.0125) * 100, 0.01) << n;
}

TEST(Polyphase, KeepsTheBandBelowTheCutoff) {
  for (const double hz : {2.0, 6.0, 8.0}) {
    const Track in = tone(hz), out = Polyphase{}(in, nullptr);
    for (Eigen::Index n = 15; n < out.frames() - 15; ++n)
      EXPECT_NEAR(out.values(n, 0), std::sin(2 * std::numbers::pi * hz * out.time(n)), 0.01) << hz;
  }
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

TEST(Sync, RefusesSoundOfAnotherUtterance) {
  const Audio audio = seconds(5);
  EXPECT_THROW(Polyphase{}(tone(1), &audio), std::runtime_error);
  EXPECT_THROW(MedianSync{}(tone(1), &audio), std::runtime_error);
}

TEST(Sync, AnswersForASingleFrame) {
  const Track one = tone(1, 1);
  EXPECT_NEAR(Polyphase{}(one, nullptr).values(0, 0), one.values(0, 0), 1e-14);
  EXPECT_EQ(MedianSync{}(one, nullptr).values, one.values);
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
