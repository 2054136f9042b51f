#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "nodes/sync/direct.h"
#include "nodes/sync/frames.h"
#include "nodes/sync/median.h"
#include "nodes/sync/polyphase.h"
#include "nodes/sync/quadrature.h"
#include "nodes/sync/together.h"

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
    if (rate.den() == 1) {
      EXPECT_EQ(Quadrature{rate}(tone(1), &audio).frames(), expected);
    }
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

// The largest value that a tone leaves, as a level under the tone's own.
double level(const Track& t) { return 20 * std::log10(t.values.middleRows(20, t.frames() - 40).cwiseAbs().maxCoeff()); }

TEST(Polyphase, SuppressesAliasesBy60dBFrom3HzAboveTheCutoff) {
  for (double hz = 15.6; hz < 50; hz += 0.7) EXPECT_LT(level(Polyphase{}(tone(hz), nullptr)), -60) << hz;
  for (double hz = 18.7; hz < 50; hz += 0.7) EXPECT_LT(level(Polyphase{.rate = ntsc}(tone(hz), nullptr)), -60) << hz;
}

TEST(Quadrature, SuppressesAliasesBy45dBFrom5HzAboveTheCutoff) {
  for (double hz = 17; hz < 50; hz += 0.7) EXPECT_LT(level(Quadrature{}(tone(hz), nullptr)), -45) << hz;
}

TEST(Quadrature, KeepsAConstantAndTheBandWithoutDelay) {
  Track constant = tone(1);
  constant.values.setConstant(3.5);
  EXPECT_LT((Quadrature{}(constant, nullptr).values.array() - 3.5).abs().maxCoeff(), 1e-12);
  for (const double hz : {1.0, 4.0, 6.0, 8.0}) {
    const Track out = Quadrature{}(tone(hz), nullptr);
    for (Eigen::Index n = 20; n < out.frames() - 20; ++n)
      EXPECT_NEAR(out.values(n, 0), std::sin(2 * std::numbers::pi * hz * out.time(n)), 0.01) << hz;
  }
}

// Forwards or backwards, the same comes out: no delay at any frequency.
TEST(Sync, GivesTheSameBackwards) {
  Track t = tone(1, 1001);
  t.start = 0.005;
  t.values.setRandom();
  Track back = t;
  back.values = t.values.colwise().reverse().eval();
  const auto expect_same = [&](const auto& sync) {
    const Eigen::MatrixXd there = sync(t, nullptr).values, again = sync(back, nullptr).values.colwise().reverse();
    ASSERT_EQ(there.rows(), again.rows());
    EXPECT_LT((there - again).cwiseAbs().maxCoeff(), 1e-11);
  };
  expect_same(Polyphase{.rate = ntsc});
  expect_same(Polyphase{.rate = 200});
  t.values.conservativeResize(1000, 1);
  back.values = t.values.colwise().reverse().eval();
  expect_same(Polyphase{});
  expect_same(MedianSync{});
}

TEST(Median, IsTheMedianOfTheCentresInEachFrame) {
  Track t = tone(1, 200);
  t.values.setRandom();
  for (const Rational rate : {Rational(25), ntsc, Rational(7), Rational(60), Rational(130)}) {
    const Track out = MedianSync{rate}(t, nullptr);
    for (Eigen::Index n = 0; n < out.frames(); ++n) {
      std::vector<double> inside;
      Eigen::Index nearest = 0;
      const double fps = rate.value(), begin = static_cast<double>(n) / fps, end = static_cast<double>(n + 1) / fps;
      for (Eigen::Index i = 0; i < t.frames(); ++i) {
        if (t.time(i) >= begin - 1e-9 && t.time(i) < end - 1e-9) inside.push_back(t.values(i, 0));
        if (std::abs(t.time(i) - out.time(n)) < std::abs(t.time(nearest) - out.time(n)) - 1e-9) nearest = i;
      }
      if (inside.empty()) inside.push_back(t.values(nearest, 0));
      std::sort(inside.begin(), inside.end());
      const auto half = inside.size() / 2;
      const double median = inside.size() % 2 ? inside[half] : (inside[half - 1] + inside[half]) / 2;
      ASSERT_EQ(out.values(n, 0), median) << rate.str() << " " << n;
    }
  }
}

TEST(Median, DoesNotDriftOverAnHour) {
  Track line = tone(1, 1);
  line.values = Eigen::VectorXd::LinSpaced(360000, 0, 359999);
  const Track out = MedianSync{ntsc}(line, nullptr);
  for (Eigen::Index n = 1; n < out.frames() - 1; n += 997)
    EXPECT_NEAR(out.values(n, 0), (out.time(n) - line.start) * 100, 0.5 + 1e-6) << n;
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

Track at_video_rate(const Rational& rate, int frames) {
  Track t = tone(1, frames);
  t.rate = rate;
  t.start = 0.5 / rate.value();
  return t;
}

TEST(Direct, PassesOnWhatLiesOnTheFramesOfTheVideo) {
  const Audio audio = seconds(3);
  for (const Rational rate : {Rational(25), ntsc}) {
    const auto frames = static_cast<int>(std::ceil(3 * rate.value()));
    const Track in = at_video_rate(rate, frames);
    EXPECT_EQ(DirectSync{rate}(in, &audio).values, in.values);
    const Track longer = at_video_rate(rate, frames + 1), shorter = at_video_rate(rate, frames - 1);
    EXPECT_EQ(DirectSync{rate}(longer, &audio).values, longer.values.topRows(frames));
    const Track repeated = DirectSync{rate}(shorter, &audio);
    ASSERT_EQ(repeated.frames(), frames);
    EXPECT_EQ(repeated.values.topRows(frames - 1), shorter.values);
    EXPECT_EQ(repeated.values.row(frames - 1), shorter.values.row(frames - 2));
  }
}

TEST(Direct, RefusesAnotherRateGridOrLength) {
  const Audio audio = seconds(3);
  EXPECT_THROW(DirectSync{ntsc}(at_video_rate(25, 75), &audio), std::runtime_error);
  Track early = at_video_rate(25, 75);
  early.start = 0.0125;
  EXPECT_THROW(DirectSync{}(early, &audio), std::runtime_error);
  EXPECT_THROW(DirectSync{}(at_video_rate(25, 73), &audio), std::runtime_error);
  EXPECT_THROW(DirectSync{}(Track{}, nullptr), std::runtime_error);
}

TEST(Sync, RefusesSoundOfAnotherUtterance) {
  const Audio audio = seconds(5);
  EXPECT_THROW(Polyphase{}(tone(1), &audio), std::runtime_error);
  EXPECT_THROW(Quadrature{}(tone(1), &audio), std::runtime_error);
  EXPECT_THROW(MedianSync{}(tone(1), &audio), std::runtime_error);
}

TEST(Sync, AnswersForASingleFrame) {
  const Track one = tone(1, 1);
  EXPECT_NEAR(Polyphase{}(one, nullptr).values(0, 0), one.values(0, 0), 1e-14);
  EXPECT_NEAR(Quadrature{}(one, nullptr).values(0, 0), one.values(0, 0), 1e-14);
  EXPECT_EQ(MedianSync{}(one, nullptr).values, one.values);
}

TEST(Sync, RefusesEmptyAndBrokenTracks) {
  Track t;
  EXPECT_THROW(Polyphase{}(t, nullptr), std::runtime_error);
  EXPECT_THROW(MedianSync{}(t, nullptr), std::runtime_error);
  t = tone(1);
  t.values(3, 0) = NAN;
  EXPECT_THROW(Polyphase{}(t, nullptr), std::runtime_error);
  EXPECT_THROW(Quadrature{}(t, nullptr), std::runtime_error);
}

TEST(Together, CutsTracksToTheFramesThatBothHave) {
  Track a = tone(1, 12), b = tone(2, 10);
  a.lost = {3, 9, 10, 11};
  Context context;
  const auto both = Together{}(a, b, context);
  EXPECT_EQ(both.a.values, a.values.topRows(10));
  EXPECT_EQ(both.a.lost, (std::vector<std::int64_t>{3, 9}));
  EXPECT_EQ(both.b.values, b.values);
  EXPECT_EQ(Together{}(b, a, context).b.frames(), 10);
}

TEST(Together, RefusesTracksThatAreUnlike) {
  Context context;
  EXPECT_THROW(Together{}(tone(1, 13), tone(1, 10), context), std::runtime_error);
  Track other = tone(1, 10);
  other.rate = ntsc;
  EXPECT_THROW(Together{}(tone(1, 10), other, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
