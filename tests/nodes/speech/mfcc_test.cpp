#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "nodes/speech/energy.h"
#include "nodes/speech/remove_mean.h"
#include "tests/nodes/speech/chains.h"
#include "tests/nodes/speech/written_out.h"

namespace talkgraph {
namespace {

using test::noise;
using test::Numbers;
using test::pi;

TEST(Mfcc, AgreesWithTheFormulasWrittenOut) {
  const Audio audio = test::voice(0.5);
  const Track track = test::mfcc(audio);
  ASSERT_EQ(track.dimension(), 20);
  double most = 0;
  for (int t = 0; t < track.frames(); t += 6) {
    const Numbers frame = test::windowed_frame(audio, t, 400, 160, 0.97, test::hamming);
    const Numbers expected = test::dct_of_logs(test::mel_sums(test::magnitudes(frame, 512), 30, 16000, 0), 1, 20);
    for (int i = 0; i < 20; ++i) most = std::max(most, std::abs(track.values(t, i) - expected[i]));
  }
  EXPECT_LT(most, 1e-10);
  RecordProperty("difference", std::to_string(1e12 * most) + "e-12");
}

// Kaldi's compute-mfcc-feats without dither: frame by frame the mean off, pre-emphasis, Povey's window, power spectrum,
// from 20 Hz, orthonormal DCT, lifter 22.
TEST(Mfcc, MatchesTheConventionsOfKaldi) {
  Audio audio = test::voice(0.3);
  audio.samples.array() += 0.01;
  const Frames frames = FramePreEmphasis{}(RemoveMean{}(Frame{}(audio)));
  const Spectrum spectrum = ShortTimeSpectrum{.kind = SpectrumKind::power}(Window{.shape = WindowShape::povey}(frames));
  const Track logs = Mel{.filters = 23, .low = 20, .floor = 1.1920929e-7}(spectrum).track;
  const Track track = Cepstrum{.coefficients = 13, .keep_zeroth = true, .orthonormal = true, .lifter = 22}(logs);
  ASSERT_EQ(track.dimension(), 13);
  for (const int t : {0, 11, 27}) {
    Numbers x(400), y(400);
    double mean = 0;
    for (int i = 0; i < 400; ++i) mean += 32768 * audio.samples[160 * t + i] / 400;
    for (int i = 0; i < 400; ++i) x[i] = 32768 * audio.samples[160 * t + i] - mean;
    for (int i = 0; i < 400; ++i)
      y[i] = (x[i] - 0.97 * x[std::max(0, i - 1)]) * std::pow(0.5 - 0.5 * std::cos(2 * pi * i / 399), 0.85);
    Numbers power = test::magnitudes(y, 512);
    for (auto& p : power) p *= p;
    const Numbers sums = test::mel_sums(power, 23, 16000, 20), c = test::dct_of_logs(sums, 1.1920929e-7, 12);
    double zeroth = 0;
    for (const double sum : sums) zeroth += std::log(sum) / std::sqrt(23.0);
    EXPECT_NEAR(track.values(t, 0), zeroth, 1e-9);
    for (int i = 1; i < 13; ++i)
      EXPECT_NEAR(track.values(t, i), c[i - 1] * (1 + 11 * std::sin(pi * i / 22)), 1e-9) << t << " " << i;
  }
}

// python_speech_features.mfcc on samples of 16 bits: no window, |DFT|² / 512, edges rounded down to bins.
TEST(Mfcc, MatchesTheConventionsOfPythonSpeechFeatures) {
  const Audio audio = test::voice(0.305);
  const Frames frames = Frame{.ends = FrameEnds::zeros}(PreEmphasis{}(audio));
  ASSERT_EQ(frames.values.rows(), 29);  // 1 + (4880 - 400) / 160, rounded up
  const Mel mel{.filters = 26, .triangles = Triangles::bins, .floor = 2.220446049250313e-16};
  const Track track = Cepstrum{.coefficients = 13, .keep_zeroth = true, .orthonormal = true, .lifter = 22}(
      mel(ShortTimeSpectrum{.kind = SpectrumKind::periodogram}(frames)).track);
  const auto to_mel = [](double hz) { return 2595 * std::log10(1 + hz / 700); };
  std::vector<int> bin(28);
  for (int m = 0; m < 28; ++m)
    bin[m] = static_cast<int>(std::floor(513 * 700 * (std::pow(10, m * to_mel(8000) / 27 / 2595) - 1) / 16000));
  for (const int t : {0, 13, 28}) {
    Numbers x(400);
    for (int i = 0; i < 400 && 160 * t + i < 4880; ++i) {
      const int at = 160 * t + i;
      x[i] = 32768 * (audio.samples[at] - 0.97 * (at > 0 ? audio.samples[at - 1] : 0));
    }
    const Numbers magnitude = test::magnitudes(x, 512);
    Numbers sums(26);
    for (int m = 0; m < 26; ++m) {
      for (int k = bin[m]; k < bin[m + 1]; ++k)
        sums[m] += magnitude[k] * magnitude[k] / 512 * (k - bin[m]) / (bin[m + 1] - bin[m]);
      for (int k = bin[m + 1]; k < bin[m + 2]; ++k)
        sums[m] += magnitude[k] * magnitude[k] / 512 * (bin[m + 2] - k) / (bin[m + 2] - bin[m + 1]);
    }
    double zeroth = 0;
    for (const double sum : sums) zeroth += std::log(sum) / std::sqrt(26.0);
    EXPECT_NEAR(track.values(t, 0), zeroth, 1e-9);
    const Numbers c = test::dct_of_logs(sums, 2.220446049250313e-16, 12);
    for (int i = 1; i < 13; ++i)
      EXPECT_NEAR(track.values(t, i), c[i - 1] * (1 + 11 * std::sin(pi * i / 22)), 1e-9) << t << " " << i;
  }
}

// What SPTK 3.9, which computes in single precision, gives for one frame:
//   awk 'BEGIN { for (i = 0; i < 400; ++i) printf "%d\n", 3000 * sin(0.1 * i) + 1000 * sin(0.002 * i * i) }' |
//     sptk x2x +af | sptk mfcc -l 400 -L 512 -m 20 -n 30 -c 22 | sptk x2x +fa%.7g
TEST(Mfcc, AgreesWithSptk) {
  const Numbers expected = {-1.343559, -34.58412, 17.42816, -4.774242, -10.00528, -3.874714, -24.18918,
                            -19.40443, -23.22596, -24.6172, -14.99709, -13.76757, -5.193965, 0.1508743,
                            2.233837,  5.900829,  4.814172, 4.481259,  3.518338,  1.795877};
  Audio audio;
  audio.samples.resize(400);
  for (int i = 0; i < 400; ++i)
    audio.samples[i] = std::trunc(3000 * std::sin(0.1 * i) + 1000 * std::sin(0.002 * i * i)) / 32768;
  const Track track =
      Cepstrum{.lifter = 22}(Mel{}(ShortTimeSpectrum{.window = {}}(FramePreEmphasis{}(Frame{}(audio)))).track);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(track.values(0, i), expected[i], 5e-6) << i;
}

TEST(PreEmphasis, FollowsItsEquation) {
  Audio a;
  a.samples = Eigen::Vector3d(1, 2, 4);
  EXPECT_TRUE(PreEmphasis{0.5}(a).samples.isApprox(Eigen::Vector3d(1, 1.5, 3)));
  EXPECT_TRUE((PreEmphasis{0.5, BeforeFirst::repeat}(a).samples.isApprox(Eigen::Vector3d(0.5, 1.5, 3))));
  a.samples.resize(0);
  EXPECT_EQ(PreEmphasis{}(a).samples.size(), 0);
}

TEST(PreEmphasis, InEachFrameStartsAnew) {
  Frames frames;
  frames.values.resize(2, 3);
  frames.values << 1, 2, 4, 8, 6, 6;
  FrameMatrix expected(2, 3);
  expected << 0.5, 1.5, 3, 4, 2, 3;
  EXPECT_TRUE(FramePreEmphasis{0.5}(frames).values.isApprox(expected));
  frames.values.resize(0, 3);
  EXPECT_EQ(FramePreEmphasis{}(frames).values.rows(), 0);
}

TEST(RemoveMean, TakesEachFramesOwn) {
  Frames frames;
  frames.values.resize(2, 2);
  frames.values << 1, 3, 5, 5;
  FrameMatrix expected(2, 2);
  expected << -1, 1, 0, 0;
  EXPECT_EQ(RemoveMean{}(frames).values, expected);
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
    const Eigen::ArrayXXd more = Mel{}(spectrum(Frame{}(loud))).track.values - Mel{}(spectrum(Frame{}(a))).track.values;
    EXPECT_LT((more - share).abs().maxCoeff(), 1e-10);
  }
}

TEST(Mel, SaysWhereItsFiltersLie) {
  const Bands bands = Mel{.filters = 3}(ShortTimeSpectrum{}(Frame{}(noise(800, 8000)))).bands;
  EXPECT_EQ(bands.nyquist, 4000);
  ASSERT_EQ(bands.centres.size(), 3);
  EXPECT_NEAR(bands.centres[1], 1113.84, 0.01);
}

// Where librosa's documentation puts hertz on Slaney's scale: 200 Hz at 3 mel, 440 at 6.6, 1000 at 15, 6400 at 42.
TEST(Mel, KnowsSlaneysScale) {
  const Mel mel{.filters = 13, .mel = MelScale::slaney, .triangles = Triangles::hertz};
  const Eigen::VectorXd edges =
      Mel{.filters = 13, .high = 6400, .mel = MelScale::slaney}.edges(8000);  // steps of 3 mel
  EXPECT_NEAR(edges[1], 200, 1e-9);
  EXPECT_NEAR(edges[5], 1000, 1e-9);
  EXPECT_NEAR(edges[14], 6400, 1e-9);
  EXPECT_NEAR(edges[6] / edges[5], std::pow(6.4, 3 / 27.0), 1e-12);
  // Triangles linear in hertz; of area one on demand.
  Mel area = mel;
  area.unit_area = true;
  const Eigen::MatrixXd peak = mel.weights(8001, 1), unit = area.weights(8001, 1);
  const Eigen::VectorXd hz = mel.edges(8000);
  for (int m = 0; m < 13; ++m) {
    EXPECT_NEAR(unit.col(m).sum(), 1, 1e-3);
    const auto k = static_cast<Eigen::Index>((hz[m] + hz[m + 1]) / 2);
    EXPECT_NEAR(peak(k, m), (static_cast<double>(k) - hz[m]) / (hz[m + 1] - hz[m]), 1e-12);
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
    const Spectrum periodogram = ShortTimeSpectrum{.kind = SpectrumKind::periodogram, .size = size}(frames);
    ASSERT_EQ(magnitude.values.cols(), size / 2 + 1);
    EXPECT_DOUBLE_EQ(magnitude.bin_hz(), 16000.0 / size);
    for (int t = 0; t < 70; ++t)
      for (int k = 0; k <= size / 2; ++k) {
        std::complex<double> sum = 0;
        for (int i = 0; i < 5; ++i) sum += frames.values(t, i) * std::polar(1.0, -2 * pi * k * i / size);
        EXPECT_NEAR(magnitude.values(t, k), std::abs(sum), 1e-13);
        EXPECT_NEAR(power.values(t, k), std::norm(sum), 1e-13);
        EXPECT_NEAR(periodogram.values(t, k), std::norm(sum) / size, 1e-13);
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

TEST(Window, HasOtherShapesAndSpans) {
  Eigen::RowVectorXd expected(5);
  expected << 0, 0.34, 1, 0.34, 0;
  EXPECT_LT((Window{WindowShape::blackman}.weights(5) - expected).cwiseAbs().maxCoeff(), 1e-14);
  expected << 0, std::pow(0.5, 0.85), 1, std::pow(0.5, 0.85), 0;
  EXPECT_LT((Window{WindowShape::povey}.weights(5) - expected).cwiseAbs().maxCoeff(), 1e-14);
  // A longer symmetric window without its last sample, or without both ends.
  const Window whole{WindowShape::hann};
  EXPECT_TRUE((Window{WindowShape::hann, WindowSpan::periodic}.weights(8).isApprox(whole.weights(9).head(8))));
  EXPECT_TRUE((Window{WindowShape::hann, WindowSpan::open}.weights(8).isApprox(whole.weights(10).segment(1, 8))));
}

TEST(Spectrum, WeighsTheFramesOnTheWay) {
  const Frames frames = Frame{}(noise(4000));
  const Window window{WindowShape::blackman};
  EXPECT_TRUE(ShortTimeSpectrum{.window = window}(frames).values.isApprox(ShortTimeSpectrum{}(window(frames)).values));
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
  const Track orthonormal = Cepstrum{.coefficients = 30, .keep_zeroth = true, .orthonormal = true}(log_filters);
  EXPECT_TRUE(orthonormal.values.rowwise().norm().isApprox(log_filters.values.rowwise().norm()));
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
