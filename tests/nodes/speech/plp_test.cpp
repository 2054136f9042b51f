#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/nodes/speech/chains.h"
#include "tests/nodes/speech/written_out.h"

namespace talkgraph {
namespace {

using test::Numbers;
using test::pi;

Numbers power(const Numbers& frame, int size) {
  Numbers out = test::magnitudes(frame, size);
  for (auto& x : out) x *= x;
  return out;
}

/// Critical bands as rastamat's fft2barkmx makes them.
Numbers bark_sums(const Numbers& spectrum, int filters, double rate) {
  const auto bark = [](double hz) { return 6 * std::asinh(hz / 600); };
  Numbers out(filters);
  for (int m = 0; m < filters; ++m) {
    const double mid = m * bark(rate / 2) / (filters - 1);
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
      const double z = bark(static_cast<double>(k) * rate / 2 / static_cast<double>(spectrum.size() - 1));
      const double below = z - mid - 0.5, above = z - mid + 0.5;
      out[m] += spectrum[k] * std::pow(10, std::min(0.0, std::min(above, -2.5 * below)));
    }
  }
  return out;
}

double equal_loudness_hz(double f) {
  return std::pow(f * f / (f * f + 1.6e5), 2) * ((f * f + 1.44e6) / (f * f + 9.61e6));
}

double equal_loudness(double f) {
  const double w = 2 * pi * f;
  return (w * w + 56.8e6) * std::pow(w, 4) / (std::pow(w * w + 6.3e6, 2) * (w * w + 0.38e9));
}

/// Cepstrum of the all-pole model of an even spectrum given at points from 0 to π: its inverse DFT as a whole, the
/// normal equations solved as they stand, the cepstrum as the mean of ln 1 / |A|² against cosines.
Numbers all_pole_cepstrum(const Numbers& points, int order, int count) {
  const auto last = static_cast<int>(points.size()) - 1;
  Eigen::VectorXd r = Eigen::VectorXd::Zero(order + 1);
  for (int lag = 0; lag <= order; ++lag)
    for (int i = 0; i < 2 * last; ++i)
      r[lag] += points[i <= last ? i : 2 * last - i] * std::cos(pi * lag * i / last) / (2 * last);
  Eigen::MatrixXd matrix(order, order);
  for (int i = 0; i < order; ++i)
    for (int j = 0; j < order; ++j) matrix(i, j) = r[std::abs(i - j)];
  const Eigen::VectorXd a = matrix.fullPivLu().solve(r.tail(order));
  const int grid = 1 << 14;
  Numbers c(count);
  for (int g = 0; g < grid; ++g) {
    std::complex<double> inverse = 1;
    for (int k = 1; k <= order; ++k) inverse -= a[k - 1] * std::polar(1.0, -2 * pi * g * k / grid);
    for (int n = 1; n <= count; ++n) c[n - 1] -= std::log(std::norm(inverse)) * std::cos(2 * pi * g * n / grid) / grid;
  }
  return c;
}

double difference(const Track& track, int t, const Numbers& expected) {
  double most = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    most = std::max(most, std::abs(track.values(t, static_cast<Eigen::Index>(i)) - expected[i]));
  return most;
}

TEST(Plp, InTheConventionOfHtkAgreesWithTheFormulasWrittenOut) {
  const Audio audio = test::voice(0.5);
  const Track track = test::plp(audio);
  ASSERT_EQ(track.dimension(), 20);
  double most = 0;
  for (const int t : {0, 7, 20, 47}) {
    Numbers sums =
        test::mel_sums(power(test::windowed_frame(audio, t, 400, 160, 0.97, test::hamming), 512), 30, 16000, 0);
    for (int m = 0; m < 30; ++m) {
      const double hz = 700 * (std::exp((m + 1) * test::mel(8000) / 31 / 1127) - 1);
      sums[m] = std::pow(std::max(1.0, sums[m]) * equal_loudness_hz(hz), 0.33);
    }
    sums.insert(sums.begin(), sums.front());
    sums.push_back(sums.back());
    most = std::max(most, difference(track, t, all_pole_cepstrum(sums, 20, 20)));
  }
  EXPECT_LT(most, 1e-10);
  RecordProperty("difference", std::to_string(1e12 * most) + "e-12");
}

/// Critical bands of every frame, RASTA or not, loudness, edges copied, cepstra.
std::vector<Numbers> bark_plp(const std::vector<Numbers>& frames, bool rasta, double (*curve)(double), double floor) {
  std::vector<Numbers> bands;
  for (const auto& frame : frames) bands.push_back(bark_sums(power(frame, 512), 30, 16000));
  for (auto& frame : bands)
    for (auto& x : frame) x = std::log(std::max(floor, x));
  if (rasta) {
    const auto x = bands;
    for (int m = 0; m < 30; ++m)
      for (std::size_t t = 0; t < bands.size(); ++t)
        bands[t][m] =
            t < 4 ? 0
                  : 0.2 * x[t][m] + 0.1 * x[t - 1][m] - 0.1 * x[t - 3][m] - 0.2 * x[t - 4][m] + 0.94 * bands[t - 1][m];
  }
  std::vector<Numbers> out;
  for (auto& frame : bands) {
    for (int m = 0; m < 30; ++m) {
      const double hz = 600 * std::sinh(m * 6 * std::asinh(8000 / 600.0) / 29 / 6);
      frame[m] = std::pow(std::exp(frame[m]) * curve(hz), 0.33);
    }
    frame[0] = frame[1];
    frame[29] = frame[28];
    out.push_back(all_pole_cepstrum(frame, 20, 20));
  }
  return out;
}

TEST(Plp, InBarkBandsAgreesWithTheFormulasWrittenOut) {
  const Audio audio = test::voice(0.3);
  const Track plain = test::plp_bark(audio), rasta = test::rasta_plp(audio);
  std::vector<Numbers> frames;
  for (int t = 0; t < plain.frames(); ++t)
    frames.push_back(test::windowed_frame(audio, t, 400, 160, 0.97, test::hamming));
  for (const auto& [track, with] : {std::pair(plain, false), {rasta, true}}) {
    const auto expected = bark_plp(frames, with, equal_loudness, 1);
    ASSERT_EQ(track.frames(), static_cast<Eigen::Index>(expected.size()));
    double most = 0;
    for (int t = 0; t < track.frames(); ++t) most = std::max(most, difference(track, t, expected[t]));
    EXPECT_LT(most, 1e-10);
    RecordProperty(with ? "rasta" : "plain", std::to_string(1e12 * most) + "e-12");
  }
}

// rastamat: no pre-emphasis, hanning, its rounded equal loudness, no floor, cepstra by n^0.6.
TEST(Plp, MatchesTheConventionsOfRastamat) {
  const Audio audio = test::voice(0.3);
  std::vector<Numbers> frames;
  const Frames cut = Frame{}(audio);
  for (int t = 0; t < cut.values.rows(); ++t)
    frames.push_back(test::windowed_frame(audio, t, 400, 160, 0, test::hanning));
  const Window window{.shape = WindowShape::hann, .span = WindowSpan::open};
  const auto [track, bands] = Bark{.floor = 1e-300}(ShortTimeSpectrum{.kind = SpectrumKind::power}(window(cut)));
  const Track cepstra = AllPole{.lifter_exponent = 0.6}(Loudness{.curve = EqualLoudness::htk}(Rasta{}(track), bands));
  const auto expected = bark_plp(frames, true, equal_loudness_hz, 1e-300);
  for (int t = 0; t < cepstra.frames(); ++t)
    for (int n = 1; n <= 20; ++n)
      ASSERT_NEAR(cepstra.values(t, n - 1), std::pow(n, 0.6) * expected[t][n - 1], 1e-9) << t << " " << n;
}

TEST(Bark, WeighsFlatTopsAndSkirts) {
  const Bark bark{.filters = 5};
  const Eigen::MatrixXd w = bark.weights(257, 31.25);
  const Eigen::VectorXd centres = bark.centres(8000);
  EXPECT_EQ(centres[0], 0);
  EXPECT_NEAR(centres[4], 8000, 1e-9);
  const auto z = [](double hz) { return 6 * std::asinh(hz / 600); };
  for (int k = 0; k < 257; ++k) {
    const double off = z(k * 31.25) - z(centres[2]);
    const double log = off < -0.5 ? off + 0.5 : off > 0.5 ? -2.5 * (off - 0.5) : 0;
    EXPECT_NEAR(std::log10(w(k, 2)), log, 1e-9);
  }
  const Eigen::MatrixXd cut = Bark{.filters = 5, .truncated = true}.weights(257, 31.25);
  for (int k = 0; k < 257; ++k) {
    const double off = z(k * 31.25) - z(centres[2]);
    EXPECT_EQ(cut(k, 2), off < -2.5 || off > 1.3 ? 0 : w(k, 2)) << off;
  }
  EXPECT_NEAR(std::log10(Bark{.filters = 5, .width = 2}.weights(257, 31.25)(0, 2)), std::log10(w(0, 2)) / 2, 1e-12);
}

TEST(Bark, RefusesBandsBeyondNyquist) {
  const Spectrum spectrum = ShortTimeSpectrum{.kind = SpectrumKind::power}(Frame{}(test::noise(800)));
  EXPECT_THROW((Bark{.high = 9000}(spectrum)), std::invalid_argument);
  EXPECT_THROW((Bark{.low = 5000, .high = 4000}(spectrum)), std::invalid_argument);
}

TEST(Loudness, HasTheCurvesOfItsSources) {
  const auto e = [](EqualLoudness curve, double hz, double nyquist = 8000) {
    return std::exp(log_equal_loudness(curve, hz, nyquist));
  };
  for (const double hz : {50.0, 400.0, 1000.0, 4000.0, 7900.0}) {
    EXPECT_NEAR(e(EqualLoudness::hermansky, hz), equal_loudness(hz), 1e-14);
    EXPECT_NEAR(e(EqualLoudness::htk, hz), equal_loudness_hz(hz), 1e-14);
    EXPECT_NEAR(e(EqualLoudness::htk, hz) / e(EqualLoudness::hermansky, hz), 1, 0.01) << "rounded constants";
    EXPECT_EQ(e(EqualLoudness::none, hz), 1);
    const double w6 = std::pow(2 * pi * hz, 6);
    EXPECT_NEAR(e(EqualLoudness::hermansky_above_5khz, hz) * (w6 + 9.58e26) / equal_loudness(hz), 1, 1e-12);
    EXPECT_EQ(e(EqualLoudness::hermansky_above_5khz, hz, 5000), e(EqualLoudness::hermansky, hz));
  }
  EXPECT_TRUE(std::isfinite(log_equal_loudness(EqualLoudness::htk, 0, 8000)));
}

TEST(Loudness, AddsTheCurveAndTakesThePower) {
  Track track;
  track.values = Eigen::MatrixXd::Random(4, 2);
  const Bands bands{Eigen::Vector2d(300, 3000), 4000};
  const Track out = Loudness{.power = 0.5}(track, bands);
  EXPECT_NEAR(out.values(3, 1), 0.5 * (track.values(3, 1) + std::log(equal_loudness(3000))), 1e-14);
  track.values.resize(4, 3);
  EXPECT_THROW(Loudness{}(track, bands), std::invalid_argument);
}

Track ramp(int frames, Rational rate = Rational(100)) {
  Track t;
  t.rate = rate;
  t.values.resize(frames, 2);
  for (int i = 0; i < frames; ++i) t.values.row(i) << i, std::sin(0.3 * i);
  return t;
}

TEST(Rasta, FollowsItsEquationFromEitherStart) {
  const Track x = ramp(40);
  for (const auto start : {RastaStart::zero, RastaStart::steady}) {
    const Track y = Rasta{.pole = 0.98, .start = start}(x);
    const auto at = [&](int t, int d) { return x.values(std::max(0, t), d); };
    for (int d = 0; d < 2; ++d)
      for (int t = 0; t < 40; ++t) {
        const double before = t > 0 ? y.values(t - 1, d) : 0;
        const double expected = (2 * at(t, d) + at(t - 1, d) - at(t - 3, d) - 2 * at(t - 4, d)) / 10 + 0.98 * before;
        EXPECT_NEAR(y.values(t, d), start == RastaStart::zero && t < 4 ? 0 : expected, 1e-13) << t;
      }
  }
}

TEST(Rasta, LetsWhatStaysTheSameFade) {
  Track x = ramp(400);
  x.values.col(0).setConstant(17);
  x.values.col(1).tail(390).array() += 100;  // a louder microphone from frame 10 on
  Track quiet = ramp(400);
  const Eigen::MatrixXd difference = Rasta{}(x).values - Rasta{}(quiet).values;
  EXPECT_TRUE(Rasta{}(x).values.col(0).isZero(0));
  EXPECT_GT(difference.col(1).cwiseAbs().maxCoeff(), 10);
  EXPECT_LT(std::abs(difference(399, 1)), 1e-7);
}

TEST(Rasta, KeepsThePoleOrItsTimeConstantAtOtherRates) {
  EXPECT_EQ(Rasta{}.pole_at(Rational(25)), 0.94);
  const Rasta slow{.keep = RastaKeep::time_constant};
  EXPECT_NEAR(slow.pole_at(Rational(25)), std::pow(0.94, 4), 1e-15);
  EXPECT_NEAR(slow.pole_at(Rational(100)), 0.94, 1e-15);
  const Track x = ramp(30, Rational(25));
  EXPECT_TRUE(slow(x).values.isApprox(Rasta{.pole = std::pow(0.94, 4)}(x).values, 1e-14));
}

TEST(Rasta, StepByStepIsTheWhole) {
  const Track x = ramp(30);
  const Rasta rasta;
  const Track whole = rasta(x);
  Rasta::State state;
  for (int t = 0; t < 30; ++t) {
    Eigen::VectorXd bands = x.values.row(t);
    rasta.step(state, rasta.pole_at(x.rate), bands);
    EXPECT_EQ(bands, whole.values.row(t).transpose());
  }
  EXPECT_EQ(rasta(ramp(0)).frames(), 0);
  EXPECT_TRUE(rasta(ramp(3)).values.isZero(0));
}

TEST(AllPole, TakesTheEdgesAsAsked) {
  srand(3);
  Track logs;
  logs.values = Eigen::MatrixXd::Random(70, 12);  // more than a block
  for (const auto edges : {EdgeBands::copied, EdgeBands::added, EdgeBands::kept}) {
    const Track out = AllPole{.edges = edges, .order = 8, .coefficients = 13}(logs);
    for (const int t : {0, 69}) {
      Numbers points(12);
      for (int m = 0; m < 12; ++m) points[m] = std::exp(logs.values(t, m));
      if (edges == EdgeBands::copied) points[0] = points[1], points[11] = points[10];
      if (edges == EdgeBands::added) points.insert(points.begin(), points[0]), points.push_back(points.back());
      EXPECT_LT(difference(out, t, all_pole_cepstrum(points, 8, 12)), 1e-12);
    }
  }
}

TEST(AllPole, LiftsAndKeepsTheGainOnDemand) {
  Track logs;
  logs.values = Eigen::MatrixXd::Random(3, 20), logs.values.row(0).setConstant(5);
  const AllPole plain{.order = 10, .coefficients = 15};
  AllPole lifted = plain;
  lifted.keep_zeroth = true;
  lifted.lifter = 22;
  lifted.lifter_exponent = 0.6;
  const Track a = plain(logs), b = lifted(logs);
  ASSERT_EQ(a.dimension(), 14);
  ASSERT_EQ(b.dimension(), 15);
  EXPECT_EQ(a.names.front(), "c1");
  EXPECT_EQ(b.names.front(), "c0");
  for (int n = 1; n < 15; ++n)
    EXPECT_TRUE(b.values.col(n).isApprox(a.values.col(n - 1) * (1 + 11 * std::sin(pi * n / 22)) * std::pow(n, 0.6)));
  // A flat spectrum of e^5 is e^5 of white noise: nothing to predict.
  EXPECT_NEAR(b.values(0, 0), 5, 1e-13);
  EXPECT_LT(a.values.row(0).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(AllPole, RefusesOrdersThatTheBandsDoNotGive) {
  Track logs;
  logs.values = Eigen::MatrixXd::Zero(2, 20);
  EXPECT_THROW(AllPole{.order = 20}(logs), std::invalid_argument);
  EXPECT_NO_THROW(AllPole{.order = 19}(logs));
  EXPECT_NO_THROW((AllPole{.edges = EdgeBands::added, .order = 21}(logs)));
  logs.values.resize(2, 2);
  EXPECT_THROW(AllPole{.order = 1}(logs), std::invalid_argument);
  logs.values.resize(0, 30);
  EXPECT_EQ(AllPole{}(logs).frames(), 0);
}

}  // namespace
}  // namespace talkgraph
