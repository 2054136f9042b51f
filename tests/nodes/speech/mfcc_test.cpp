#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "graph/random.h"
#include "nodes/speech/cepstrum.h"
#include "nodes/speech/energy.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/join.h"
#include "nodes/speech/mel.h"
#include "nodes/speech/preemphasis.h"
#include "nodes/speech/spectrum.h"
#include "nodes/speech/stack.h"
#include "nodes/speech/window.h"

namespace talkgraph {
namespace {

constexpr double pi = std::numbers::pi;

Audio noise(int samples, double rate = 16000) {
  Audio a;
  a.rate = rate;
  a.samples.resize(samples);
  Random random(7);
  for (auto& x : a.samples) x = 0.1 * random.normal();
  return a;
}

Track mfcc(const Audio& audio) {
  return Cepstrum{}(Mel{}(ShortTimeSpectrum{}(Window{}(Frame{}(PreEmphasis{}(audio))))));
}

// The whole chain once more, written straight from the formulas: direct DFT,
// filters by their edges in Hz.
std::vector<double> direct_mfcc(const Audio& audio, int t) {
  const int n = 400, hop = 160, size = 512, filters = 30;
  std::vector<double> x(n);
  for (int i = 0; i < n; ++i) {
    const int at = t * hop + i;
    const double before = at > 0 ? audio.samples[at - 1] : audio.samples[0];
    x[i] = 32768 * (audio.samples[at] - 0.97 * before) * (0.54 - 0.46 * std::cos(2 * pi * i / (n - 1)));
  }
  std::vector<double> magnitude(size / 2 + 1);
  for (int k = 0; k <= size / 2; ++k) {
    std::complex<double> sum = 0;
    for (int i = 0; i < n; ++i) sum += x[i] * std::polar(1.0, -2 * pi * k * i / size);
    magnitude[k] = std::abs(sum);
  }
  const auto mel = [](double hz) { return 1127 * std::log(1 + hz / 700); };
  std::vector<double> log_filter(filters);
  for (int m = 0; m < filters; ++m) {
    const double step = mel(8000) / (filters + 1), left = m * step, centre = left + step, right = centre + step;
    double sum = 0;
    for (int k = 0; k <= size / 2; ++k) {
      const double at = mel(k * 8000.0 / (size / 2));
      if (at > left && at <= centre) sum += magnitude[k] * (at - left) / step;
      if (at > centre && at < right) sum += magnitude[k] * (right - at) / step;
    }
    log_filter[m] = std::log(std::max(1.0, sum));
  }
  std::vector<double> c;
  for (int i = 1; i <= 20; ++i) {
    double sum = 0;
    for (int m = 0; m < filters; ++m) sum += log_filter[m] * std::cos(pi * i * (m + 0.5) / filters);
    c.push_back(std::sqrt(2.0 / filters) * sum);
  }
  return c;
}

TEST(Mfcc, AgreesWithTheFormulasWrittenOut) {
  const Audio audio = noise(4000);
  const Track track = mfcc(audio);
  ASSERT_EQ(track.dimension(), 20);
  for (const int t : {0, 5, static_cast<int>(track.frames()) - 1}) {
    const auto expected = direct_mfcc(audio, t);
    for (int i = 0; i < 20; ++i) EXPECT_NEAR(track.values(t, i), expected[i], 1e-9) << t << " " << i;
  }
}

TEST(Mfcc, IsFiniteOnSilenceClippingAndOneSample) {
  Audio audio;
  for (const int n : {1, 399, 16000}) {
    audio.samples = Eigen::VectorXd::Zero(n);
    EXPECT_TRUE(mfcc(audio).values.allFinite()) << n;
    audio.samples.setOnes();
    EXPECT_TRUE(mfcc(audio).values.allFinite()) << n;
  }
  audio.samples.resize(0);
  EXPECT_EQ(mfcc(audio).frames(), 1);
}

TEST(Frame, CountsWholeFramesAndDoesNotDrift) {
  EXPECT_EQ(Frame{}(noise(400)).values.rows(), 1);
  EXPECT_EQ(Frame{}(noise(559)).values.rows(), 1);
  EXPECT_EQ(Frame{}(noise(560)).values.rows(), 2);
  // 22.05 kHz has 220.5 samples in 10 ms.
  Audio ramp;
  ramp.rate = 22050;
  ramp.samples = Eigen::VectorXd::LinSpaced(22050 * 60, 0, 22050 * 60 - 1);
  const Frames frames = Frame{}(ramp);
  EXPECT_EQ(frames.values(5000, 0), 5000 * 220.5);
  EXPECT_EQ(frames.values(5001, 0), std::round(5001 * 220.5));
  EXPECT_DOUBLE_EQ(frames.start, 0.0125);
}

TEST(Frame, RefusesHopsShorterThanASample) {
  EXPECT_THROW((Frame{.window = 0.025, .rate = 20000}(noise(1000))), std::invalid_argument);
  EXPECT_THROW((Frame{.window = 1e-6}(noise(1000))), std::invalid_argument);
}

TEST(PreEmphasis, FollowsItsEquation) {
  Audio a;
  a.samples = Eigen::Vector3d(1, 2, 4);
  EXPECT_TRUE(PreEmphasis{0.5}(a).samples.isApprox(Eigen::Vector3d(0.5, 1.5, 3)));
  a.samples.resize(0);
  EXPECT_EQ(PreEmphasis{}(a).samples.size(), 0);
}

TEST(Mel, RefusesFiltersBeyondNyquist) {
  const auto spectrum = ShortTimeSpectrum{}(Frame{}(noise(800)));
  EXPECT_THROW((Mel{.high = 9000}(spectrum)), std::invalid_argument);
  EXPECT_THROW((Mel{.low = 5000, .high = 4000}(spectrum)), std::invalid_argument);
}

TEST(Spectrum, RefusesADftShorterThanTheFrame) {
  EXPECT_THROW((ShortTimeSpectrum{.size = 256}(Frame{}(noise(800)))), std::invalid_argument);
  EXPECT_THROW((ShortTimeSpectrum{.size = 500}(Frame{}(noise(800)))), std::invalid_argument);
}

TEST(Energy, IsTheLogOfTheSumOfSquares) {
  Audio a;
  a.samples = Eigen::VectorXd::Constant(400, 0.5);
  EXPECT_NEAR(Energy{}(Frame{}(a)).values(0, 0), std::log(400 * 16384.0 * 16384.0), 1e-12);
  a.samples.setZero();
  EXPECT_EQ(Energy{}(Frame{}(a)).values(0, 0), 0);
}

TEST(Join, PutsColumnsSideBySideOverTheCommonLength) {
  Track a, b;
  a.values = Eigen::MatrixXd::Ones(5, 2);
  b.values = Eigen::MatrixXd::Zero(4, 1);
  EXPECT_EQ(Join{}(a, b).values.rows(), 4);
  EXPECT_EQ(Join{}(a, b).values.cols(), 3);
  b.values.resize(2, 1);
  EXPECT_THROW(Join{}(a, b), std::runtime_error);
  b.rate = Rational(50);
  EXPECT_THROW(Join{}(a, b), std::runtime_error);
}

TEST(Stack, RepeatsTheEnds) {
  Track a;
  a.values = Eigen::Vector3d(1, 2, 3);
  Eigen::MatrixXd expected(3, 3);
  expected << 1, 1, 2, 1, 2, 3, 2, 3, 3;
  EXPECT_EQ((Stack{1, 1}(a).values), expected);
}

}  // namespace
}  // namespace talkgraph
