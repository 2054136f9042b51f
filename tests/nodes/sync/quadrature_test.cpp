#include "nodes/sync/quadrature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace talkgraph {
namespace {

using std::numbers::pi;

/// A track of `ratio` frames a video frame; the middle of video frame n lies `phase` input frames behind frame n ·
/// ratio.
Track noise(int ratio, int frames, double phase = 0) {
  Track t;
  t.rate = Rational(25 * ratio);
  t.start = 0.02 - phase / t.rate.value();
  t.values = Eigen::VectorXd::Random(frames);
  return t;
}

/// A cosine-modulated bank of M bands, written out: analysed around every video frame, mapped back one by one.
struct Bank {
  int bands, length;
  double beta, cutoff = 0;

  Bank(int m, int l, double b) : bands(m), length(l), beta(b) {
    // The cut-off at which the response at the crossing of two bands is 3 dB below that at 0, by the secant method.
    const auto miss = [&](double c) {
      cutoff = c;
      double at_0 = 0, at_crossing = 0;
      for (int t = -length * bands; t <= length * bands; ++t) {
        at_0 += prototype(t);
        at_crossing += prototype(t) * std::cos(pi * t / (2 * bands));
      }
      return at_crossing / at_0 - std::sqrt(0.5);
    };
    double a = 0.45 * pi / bands, c = 0.6 * pi / bands, at_a = miss(a);
    for (int i = 0; i < 100 && std::abs(a - c) > 1e-15; ++i) {
      const double at_c = miss(c), next = at_c == at_a ? c : c - at_c * (c - a) / (at_c - at_a);
      a = c, at_a = at_c, c = next;
    }
    double energy = 0;  // of the whole bank: Σ_k |H_k|² is flat, its mean the sum of the squares
    for (int k = 0; k < bands; ++k)
      for (int t = -length * bands; t <= length * bands; ++t) energy += std::pow(response(k, t), 2);
    scale = std::sqrt(bands / energy);
  }

  double prototype(double t) const {
    const double x = t / (length * bands);
    if (std::abs(x) > 1) return 0;
    const double window = std::cyl_bessel_i(0.0, beta * std::sqrt(1 - x * x));
    return window * (t == 0 ? cutoff / pi : std::sin(cutoff * t) / (pi * t));
  }

  double response(int k, double t) const {
    return scale * prototype(t) * std::cos((2 * k + 1) * pi * t / (2 * bands) + (k % 2 ? -1 : 1) * pi / 4);
  }

  /// What band k makes of x at input time `at`; x's middle of video frame s lies `phase` behind s · bands.
  double mapped_back(int k, const Eigen::VectorXd& x, double at, double phase) const {
    double sum = 0;
    const int frames = static_cast<int>(x.size()) / bands;
    for (int s = 0; s < frames; ++s) {
      const double centre = s * bands + phase, synthesis = response(k, centre - at);
      if (synthesis == 0) continue;
      for (int i = 0; i < x.size(); ++i) sum += synthesis * x[i] * response(k, centre - i);
    }
    return sum;
  }

  double scale = 1;
};

// Between the input's frames its highest band is not defined, so the middles lie on frames or half-way.
TEST(Quadrature, ItsBankNearlyReconstructsTheInput) {
  for (const int ratio : {2, 3, 4, 8})
    for (const double phase : {0.0, 0.5}) {
      const Bank bank(ratio, 8, 9);
      const Track in = noise(ratio, 48 * ratio);
      double error = 0, power = 0;
      for (int i = 20 * ratio; i < 28 * ratio; ++i) {
        double y = 0;
        for (int k = 0; k < ratio; ++k) y += bank.mapped_back(k, in.values, i, phase);
        error += std::pow(y - in.values(i), 2);
        power += std::pow(in.values(i), 2);
      }
      EXPECT_LT(10 * std::log10(error / power), -45) << ratio << " " << phase;
    }
}

TEST(Quadrature, IsTheLowestBandOfTheBank) {
  for (const int ratio : {2, 3, 4, 8})
    for (const double phase : {0.0, 0.75}) {
      const Bank bank(ratio, 8, 9);
      const Track in = noise(ratio, 60 * ratio, phase);
      const Track out = Quadrature{}(in, nullptr);
      // Without normalisation a constant is changed as little as the bank is from perfect reconstruction.
      const double gain = bank.mapped_back(0, Eigen::VectorXd::Ones(60 * ratio), 30 * ratio + phase, phase);
      EXPECT_NEAR(gain, 1, 0.01);
      for (int n = 20; n < 40; ++n)
        EXPECT_NEAR(out.values(n, 0), bank.mapped_back(0, in.values, n * ratio + phase, phase) / gain, 1e-9) << n;
    }
}

TEST(Quadrature, RefusesRatiosThatAreNoInteger) {
  const Track in = noise(4, 100);
  for (const Rational rate : {Rational(30000, 1001), Rational(24), Rational(100), Rational(200)}) {
    try {
      Quadrature{rate}(in, nullptr);
      FAIL() << rate.str();
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("use sync.polyphase"));
    }
  }
}

}  // namespace
}  // namespace talkgraph
