#include "nodes/smooth/lowpass_online.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace talkgraph {
namespace {

constexpr double pi = std::numbers::pi;

Track tone(double hz, int frames = 400) {
  Track t;
  t.values.resize(frames, 1);
  for (int i = 0; i < frames; ++i) t.values(i, 0) = std::cos(2 * pi * hz * i / 25);
  return t;
}

/// Of the analogue Butterworth filter 1/(1 + √2 s + s²) at s = i tan(πf/r)/tan(πc/r).
std::complex<double> response(double hz, double cutoff) {
  const std::complex<double> s(0, std::tan(pi * hz / 25) / std::tan(pi * cutoff / 25));
  return 1.0 / (1.0 + std::numbers::sqrt2 * s + s * s);
}

TEST(LowpassOnline, HasTheResponseOfItsDesignReadLate) {
  for (const int delay : {0, 1, 3})
    for (const double hz : {0.5, 2.0, 5.0, 8.0}) {
      const Track out = LowpassOnline{5, delay}(tone(hz), nullptr).track;
      const auto expected = response(hz, 5) * std::polar(1.0, 2 * pi * hz * delay / 25);
      for (int i = 100; i < 300; ++i)
        EXPECT_NEAR(out.values(i, 0), (expected * std::polar(1.0, 2 * pi * hz * i / 25)).real(), 1e-6) << hz;
    }
}

TEST(LowpassOnline, OfOneFrameTakesBackTheLagOfSlowMovement) {
  const Track in = tone(0.5);
  const auto error = [&](int delay) {
    const Track out = LowpassOnline{4.898, delay}(in, nullptr).track;
    return (out.values - in.values).middleRows(50, 300).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(error(1), 2e-3);
  EXPECT_GT(error(0), 0.1);
}

TEST(LowpassOnline, KnowsNoFrameBeyondItsDelay) {
  for (const int delay : {0, 1, 3}) {
    Track in;
    in.values = Eigen::MatrixXd::Random(40, 2);
    const LowpassOnline smooth{5, delay};
    const Track out = smooth(in, nullptr).track;
    for (const int t : {0, 7, 30}) {
      Track other = in;
      other.values.conservativeResize(t + delay + 1 + 5, 2);
      other.values.bottomRows(5).setConstant(9);
      EXPECT_EQ(smooth(other, nullptr).track.values.topRows(t + 1), out.values.topRows(t + 1));
      other.values.conservativeResize(t + delay + 1, 2);
      EXPECT_EQ(smooth(other, nullptr).track.values.topRows(t + 1), out.values.topRows(t + 1));
    }
  }
}

TEST(LowpassOnline, SaysHowLongFramesWait) {
  const Scores before{{{"latency", 10}, {"latency_most", 80}}};
  const LowpassOnline smooth{5, 2};
  EXPECT_EQ(smooth(tone(1), &before).latency.values,
            (std::map<std::string, double>{{"latency", 90}, {"latency_most", 160}}));
  EXPECT_EQ(smooth(tone(1), nullptr).latency.values.at("latency"), 80);
}

TEST(LowpassOnline, StandsStillAndAnswersShortTracks) {
  Track t;
  t.values.setConstant(1, 3, 4);
  EXPECT_TRUE((LowpassOnline{}(t, nullptr).track.values.isConstant(4, 1e-12)));
  t.values.setConstant(50, 3, 4);
  EXPECT_TRUE((LowpassOnline{}(t, nullptr).track.values.isConstant(4, 1e-12)));
  t.values.resize(0, 3);
  EXPECT_EQ(LowpassOnline{}(t, nullptr).track.frames(), 0);
}

TEST(LowpassOnline, IsOffAtHalfTheRateAndRefusesNan) {
  const auto off = LowpassOnline{12.5, 2}(tone(3), nullptr);
  EXPECT_EQ(off.track.values, tone(3).values);
  EXPECT_EQ(off.latency.values.at("latency"), 0);
  Track t;
  t.values = Eigen::Vector3d(1, NAN, 2);
  EXPECT_THROW(LowpassOnline{}(t, nullptr), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
