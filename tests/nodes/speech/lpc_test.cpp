#include "nodes/speech/lpc.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "graph/random.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/line_spectrum.h"
#include "nodes/speech/lsf.h"
#include "nodes/speech/window.h"

namespace talkgraph {
namespace {

constexpr double pi = std::numbers::pi;
constexpr LpcMethod methods[] = {LpcMethod::autocorrelation, LpcMethod::covariance, LpcMethod::burg};

/// Noise through two resonances, as strongly coloured as a vowel.
Eigen::VectorXd vowel(int samples, std::uint64_t seed = 3) {
  Random random(seed);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(samples);
  for (int t = 4; t < samples; ++t)
    x[t] = 0.01 * random.normal() + 1.6 * x[t - 1] - 0.2 * x[t - 2] - 0.9 * x[t - 3] + 0.45 * x[t - 4];
  return x;
}

Frames one_frame(const Eigen::VectorXd& x) {
  Frames frames;
  frames.values = x.transpose();
  return frames;
}

Eigen::VectorXd predictor(const Lpc& how, const Eigen::VectorXd& x) {
  return how(one_frame(x)).lpc.values.row(0).transpose();
}

double gain(const Lpc& how, const Eigen::VectorXd& x) { return how(one_frame(x)).gain.values(0, 0); }

// x[t] against x[t-1] ... x[t-p] for t in from..to, the sound zero outside the frame.
Eigen::VectorXd least_squares(const Eigen::VectorXd& x, int p, Eigen::Index from, Eigen::Index to, double* power) {
  const auto at = [&](Eigen::Index t) { return t >= 0 && t < x.size() ? x[t] : 0.0; };
  Eigen::MatrixXd delayed(to - from, p);
  Eigen::VectorXd now(to - from);
  for (auto t = from; t < to; ++t) {
    now[t - from] = at(t);
    for (int k = 1; k <= p; ++k) delayed(t - from, k - 1) = at(t - k);
  }
  const Eigen::VectorXd a = delayed.colPivHouseholderQr().solve(now);
  *power = (now - delayed * a).squaredNorm();
  return a;
}

TEST(Lpc, AutocorrelationIsLeastSquaresOverTheFrameAndItsTail) {
  for (const int order : {1, 2, 10, 20, 31}) {
    const Eigen::VectorXd x = Window{}(one_frame(vowel(400))).values.row(0).transpose();
    double power = 0;
    const Eigen::VectorXd expected = least_squares(x, order, 0, x.size() + order, &power);
    const Lpc lpc{.order = order};
    EXPECT_LT((predictor(lpc, x) - expected).cwiseAbs().maxCoeff(), 1e-10) << order;
    EXPECT_NEAR(gain(lpc, x), std::sqrt(power / 400), 1e-12);
  }
}

TEST(Lpc, AutocorrelationSolvesTheNormalEquations) {
  const Eigen::VectorXd x = Window{}(one_frame(vowel(400))).values.row(0).transpose();
  Eigen::MatrixXd matrix(20, 20);
  Eigen::VectorXd r(21);
  for (int m = 0; m <= 20; ++m) {
    r[m] = 0;
    for (int t = m; t < 400; ++t) r[m] += x[t] * x[t - m];
  }
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) matrix(i, j) = r[std::abs(i - j)];
  const Eigen::VectorXd expected = matrix.ldlt().solve(r.tail(20));
  EXPECT_LT((predictor(Lpc{}, x) - expected).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Lpc, CovarianceIsLeastSquaresInsideTheFrame) {
  for (const int order : {1, 2, 10, 20}) {
    const Eigen::VectorXd x = vowel(400);
    double power = 0;
    const Eigen::VectorXd expected = least_squares(x, order, order, x.size(), &power);
    const Lpc lpc{.method = LpcMethod::covariance, .order = order};
    EXPECT_LT((predictor(lpc, x) - expected).cwiseAbs().maxCoeff(), 1e-9) << order;
    EXPECT_NEAR(gain(lpc, x), std::sqrt(power / (400 - order)), 1e-12);
  }
}

TEST(Lpc, CovarianceFindsTheRecursionOfADecayExactly) {
  Eigen::VectorXd x(50);
  x[0] = 1;
  x[1] = 0.3;
  for (int t = 2; t < 50; ++t) x[t] = 1.5 * x[t - 1] - 0.8 * x[t - 2];
  const Lpc lpc{.method = LpcMethod::covariance, .order = 2};
  EXPECT_TRUE(predictor(lpc, x).isApprox(Eigen::Vector2d(1.5, -0.8), 1e-12));
  EXPECT_NEAR(gain(lpc, x), 0, 1e-8);
}

// Burg's recursion by its definition: residuals of order m of the whole signal, filtered anew with the predictor so
// far.
TEST(Lpc, BurgIsItsDefinition) {
  for (const int order : {1, 2, 10, 20}) {
    const Eigen::VectorXd x = vowel(400);
    const auto n = x.size();
    std::vector<double> a{1};
    double power = x.squaredNorm() / static_cast<double>(n);
    for (int m = 0; m < order; ++m) {
      double num = 0, den = 0;
      for (Eigen::Index t = m + 1; t < n; ++t) {
        double f = 0, b = 0;
        for (int i = 0; i <= m; ++i) {
          f += a[i] * x[t - i];
          b += a[i] * x[t - 1 - m + i];
        }
        num += 2 * f * b;
        den += f * f + b * b;
      }
      const double k = num / den;
      std::vector<double> next(m + 2, 0.0);
      for (int i = 0; i <= m; ++i) {
        next[i] += a[i];
        next[m + 1 - i] -= k * a[i];
      }
      a = next;
      power *= 1 - k * k;
    }
    const Lpc lpc{.method = LpcMethod::burg, .order = order};
    const Eigen::VectorXd got = predictor(lpc, x);
    for (int k = 1; k <= order; ++k) EXPECT_NEAR(got[k - 1], -a[k], 1e-10) << order;
    EXPECT_NEAR(gain(lpc, x), std::sqrt(power), 1e-12);
  }
}

TEST(Lpc, EveryMethodFindsAnAutoregressiveProcess) {
  Random random(1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(200000);
  for (Eigen::Index t = 2; t < x.size(); ++t) x[t] = 1.2 * x[t - 1] - 0.7 * x[t - 2] + 0.02 * random.normal();
  for (const auto method : methods) {
    const Lpc lpc{.method = method, .order = 4};
    EXPECT_LT((predictor(lpc, x) - Eigen::Vector4d(1.2, -0.7, 0, 0)).cwiseAbs().maxCoeff(), 0.01);
    EXPECT_NEAR(gain(lpc, x), 0.02, 2e-4);
  }
}

TEST(Lpc, TheGainIsThatOfUnweighedFrames) {
  Random random(1);
  Frames frames;
  frames.values.resize(1, 20000);
  for (auto& x : frames.values.reshaped()) x = 0.1 * random.normal();
  EXPECT_NEAR(Lpc{.window = {}}(frames).gain.values(0, 0), 0.1, 0.002);
}

TEST(Lpc, RidgeIsWhiteNoiseAdded) {
  const Eigen::VectorXd x = vowel(400);
  double power = 0;
  for (const auto method : methods) {
    const Eigen::VectorXd plain = predictor({.method = method}, x),
                          little = predictor({.method = method, .ridge = 1e-9}, x),
                          all = predictor({.method = method, .ridge = 1e9}, x);
    EXPECT_LT((plain - little).norm(), 1e-3);
    EXPECT_LT(all.norm(), 1e-6);
  }
  // The normal equations with a heavier diagonal.
  const Eigen::VectorXd a = predictor({.order = 1, .ridge = 0.1}, x), b = least_squares(x, 1, 0, x.size() + 1, &power);
  EXPECT_NEAR(a[0], b[0] / 1.1, 1e-12);
}

TEST(Lpc, EveryInputHasAFiniteAnswer) {
  Context context;
  for (const auto method : methods)
    for (const double rate : {500.0, 8000.0, 44100.0, 192000.0})
      for (const int order : {1, 2, 20, 33})
        for (int kind = 0; kind < 8; ++kind) {
          Audio audio;
          audio.rate = rate;
          audio.samples.setZero(kind == 1 ? 1 : static_cast<int>(0.05 * rate));
          for (Eigen::Index t = 0; t < audio.samples.size(); ++t) {
            const double time = static_cast<double>(t) / rate, sine = std::sin(2 * pi * 500 * time);
            audio.samples[t] = kind == 0   ? 0
                               : kind == 1 ? 1
                               : kind == 2 ? 0.25  // constant
                               : kind == 3 ? sine
                               : kind == 4 ? std::clamp(10 * sine, -1.0, 1.0)
                               : kind == 5 ? (t % 2 ? 1 : -1)
                               : kind == 6 ? (t == 100 ? 1e-300 : 0)
                                           : 1 + 1e-9 * sine;
          }
          for (const auto shape : {WindowShape::rectangular, WindowShape::hamming}) {
            const LpcTracks out = Lpc{.window = {shape}, .method = method, .order = order}(Frame{}(audio));
            ASSERT_TRUE(out.lpc.values.allFinite() && out.gain.values.allFinite());
            ASSERT_GE(out.gain.values.minCoeff(), 0);
            const Track lsf = Lsf{}(out.lpc, context), back = FromLsf{}(lsf);
            ASSERT_TRUE(lsf.values.allFinite() && back.values.allFinite());
            for (Eigen::Index t = 0; t < lsf.frames(); ++t)
              for (Eigen::Index k = 0; k < order; ++k) {
                ASSERT_GT(lsf.values(t, k), 0);
                ASSERT_LT(lsf.values(t, k), pi);
                ASSERT_GE(lsf.values(t, k), k > 0 ? lsf.values(t, k - 1) : 0);
              }
            ASSERT_LE(Reflection{}(out.lpc, context).values.cwiseAbs().maxCoeff(), 1);
            ASSERT_EQ(kind == 0 && !out.gain.values.isZero(0), false);
          }
        }
}

TEST(Lpc, AutocorrelationAndBurgAreOfMinimumPhase) {
  for (const auto method : {LpcMethod::autocorrelation, LpcMethod::burg})
    for (int seed = 1; seed < 50; ++seed) {
      Eigen::VectorXd k(20);
      EXPECT_TRUE(step_down(predictor({.method = method}, vowel(100, static_cast<std::uint64_t>(seed))), k));
    }
}

TEST(Lpc, CovarianceOfATooShortFrameIsOfLowerOrder) {
  const Lpc lpc{.method = LpcMethod::covariance, .order = 20};
  EXPECT_TRUE(predictor(lpc, vowel(20)).isZero(0));
  const Eigen::VectorXd a = predictor(lpc, vowel(24));  // four equations
  EXPECT_TRUE(a.tail(16).isZero(0));
  EXPECT_FALSE(a.head(4).isZero(0));
}

}  // namespace
}  // namespace talkgraph
