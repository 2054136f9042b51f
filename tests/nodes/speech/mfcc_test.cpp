#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "graph/random.h"
#include "nodes/speech/cepstrum.h"
#include "nodes/speech/energy.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/mel.h"
#include "nodes/speech/preemphasis.h"
#include "nodes/speech/spectrum.h"
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

TEST(PreEmphasis, FollowsItsEquation) {
  Audio a;
  a.samples = Eigen::Vector3d(1, 2, 4);
  EXPECT_TRUE(PreEmphasis{0.5}(a).samples.isApprox(Eigen::Vector3d(0.5, 1.5, 3)));
  a.samples.resize(0);
  EXPECT_EQ(PreEmphasis{}(a).samples.size(), 0);
}

// Filter m of a hand-sized bank: 3 filters over 8 kHz, edges at equal steps of mel.
TEST(Mel, WeighsByHand) {
  const Mel mel{.filters = 3};
  const Eigen::MatrixXd w = mel.weights(9, 500);  // bins at 0, 500 ... 4000 Hz
  const double step = 1127 * std::log(1 + 4000 / 700.0) / 4;
  EXPECT_NEAR(step, 536.52, 0.01);
  const auto hz = [&](double edge) { return 700 * (std::exp(edge * step / 1127) - 1); };
  EXPECT_NEAR(hz(1), 426.80, 0.01);
  EXPECT_NEAR(hz(2), 1113.84, 0.01);
  EXPECT_NEAR(hz(3), 2219.77, 0.01);
  // 500 Hz lies between the centres of filters 1 and 2, 1500 Hz of 2 and 3.
  const double at500 = 1127 * std::log(1 + 500 / 700.0) / step, at1500 = 1127 * std::log(1 + 1500 / 700.0) / step;
  EXPECT_NEAR(w(1, 0), 2 - at500, 1e-12);
  EXPECT_NEAR(w(1, 1), at500 - 1, 1e-12);
  EXPECT_NEAR(w(3, 1), 3 - at1500, 1e-12);
  EXPECT_NEAR(w(3, 2), at1500 - 2, 1e-12);
  EXPECT_EQ(w(1, 2), 0);
  EXPECT_EQ(w(3, 0), 0);
  EXPECT_NEAR(w.row(0).sum() + w.row(8).sum(), 0, 1e-12);  // the edges
  // Between the outer centres the triangles of a bin add up to one.
  for (int bin = 1; bin <= 4; ++bin) EXPECT_NEAR(w.row(bin).sum(), 1, 1e-12);
}

TEST(Mel, ScalesMagnitudeAndPowerAsTheSamples) {
  Audio a = noise(800), loud = a;
  loud.samples *= 10;
  for (const auto kind : {SpectrumKind::magnitude, SpectrumKind::power}) {
    const ShortTimeSpectrum spectrum{.kind = kind};
    const double share = std::log(kind == SpectrumKind::power ? 100 : 10);
    const Eigen::ArrayXXd more = Mel{}(spectrum(Frame{}(loud))).values - Mel{}(spectrum(Frame{}(a))).values;
    EXPECT_LT((more - share).abs().maxCoeff(), 1e-10);
  }
}

TEST(Mel, RefusesFiltersBeyondNyquist) {
  const auto spectrum = ShortTimeSpectrum{}(Frame{}(noise(800)));
  EXPECT_THROW((Mel{.high = 9000}(spectrum)), std::invalid_argument);
  EXPECT_THROW((Mel{.low = 5000, .high = 4000}(spectrum)), std::invalid_argument);
}

TEST(Spectrum, IsTheDftOfThePaddedFrame) {
  // More frames than a block, an odd length, every size.
  Frames frames;
  frames.values = FrameMatrix::Random(70, 5);
  for (const int size : {8, 16}) {
    const Spectrum magnitude = ShortTimeSpectrum{.size = size}(frames);
    const Spectrum power = ShortTimeSpectrum{.kind = SpectrumKind::power, .size = size}(frames);
    ASSERT_EQ(magnitude.values.cols(), size / 2 + 1);
    EXPECT_DOUBLE_EQ(magnitude.bin_hz(), 16000.0 / size);
    for (int t = 0; t < 70; ++t)
      for (int k = 0; k <= size / 2; ++k) {
        std::complex<double> sum = 0;
        for (int i = 0; i < 5; ++i) sum += frames.values(t, i) * std::polar(1.0, -2 * pi * k * i / size);
        EXPECT_NEAR(magnitude.values(t, k), std::abs(sum), 1e-13);
        EXPECT_NEAR(power.values(t, k), std::norm(sum), 1e-13);
      }
  }
  frames.values = FrameMatrix::Ones(1, 1);
  EXPECT_TRUE(ShortTimeSpectrum{}(frames).values.isOnes());
}

TEST(Window, IsSymmetric) {
  Frames frames;
  frames.values = FrameMatrix::Ones(2, 5);
  const Eigen::RowVectorXd hamming = Window{}(frames).values.row(1),
                           hann = Window{WindowShape::hann}(frames).values.row(0);
  Eigen::RowVectorXd expected(5);
  expected << 0.08, 0.54, 1, 0.54, 0.08;
  EXPECT_TRUE(hamming.isApprox(expected, 1e-14));
  expected << 0, 0.5, 1, 0.5, 0;
  EXPECT_TRUE(hann.isApprox(expected, 1e-14));
  EXPECT_EQ(Window{WindowShape::rectangular}(frames).values, frames.values);
  frames.values = FrameMatrix::Ones(1, 1);
  EXPECT_EQ(Window{}(frames).values(0, 0), 1);
}

TEST(Spectrum, RefusesADftShorterThanTheFrame) {
  EXPECT_THROW((ShortTimeSpectrum{.size = 256}(Frame{}(noise(800)))), std::invalid_argument);
  EXPECT_THROW((ShortTimeSpectrum{.size = 500}(Frame{}(noise(800)))), std::invalid_argument);
}

TEST(Cepstrum, LiftsAndKeepsTheZerothOnDemand) {
  Track log_filters;
  log_filters.values = Eigen::MatrixXd::Random(3, 30);
  const Track plain = Cepstrum{}(log_filters), lifted = Cepstrum{.keep_zeroth = true, .lifter = 22}(log_filters);
  ASSERT_EQ(lifted.dimension(), 21);
  EXPECT_TRUE(lifted.values.col(0).isApprox(std::sqrt(2 / 30.0) * log_filters.values.rowwise().sum()));
  for (int i = 1; i <= 20; ++i) {
    const double lift = 1 + 11 * std::sin(pi * i / 22);
    EXPECT_TRUE(lifted.values.col(i).isApprox(lift * plain.values.col(i - 1)));
  }
  EXPECT_EQ(lifted.names.front(), "c0");
  EXPECT_THROW(Cepstrum{.coefficients = 31}(log_filters), std::invalid_argument);
}

TEST(Energy, IsTheLogOfTheSumOfSquares) {
  Audio a;
  a.samples = Eigen::VectorXd::Constant(400, 0.5);
  EXPECT_NEAR(Energy{}(Frame{}(a)).values(0, 0), std::log(400 * 16384.0 * 16384.0), 1e-12);
  a.samples.setZero();
  EXPECT_EQ(Energy{}(Frame{}(a)).values(0, 0), 0);
}

}  // namespace
}  // namespace talkgraph
