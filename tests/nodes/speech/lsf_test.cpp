#include "nodes/speech/lsf.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "graph/random.h"
#include "nodes/speech/levinson.h"
#include "nodes/speech/line_spectrum.h"

namespace talkgraph {
namespace {

constexpr double pi = std::numbers::pi;

/// The predictor of reflection coefficients.
Eigen::VectorXd step_up(const Eigen::VectorXd& k) {
  Eigen::VectorXd a(0);
  for (const double last : k) {
    Eigen::VectorXd next(a.size() + 1);
    next << a - last * a.reverse(), last;
    a = next;
  }
  return a;
}

Eigen::VectorXd stable_predictor(int order, double size, Random& random) {
  Eigen::VectorXd k(order);
  for (auto& x : k) x = random.uniform(-size, size);
  return step_up(k);
}

Eigen::VectorXcd roots(const Eigen::VectorXd& polynomial) {
  const auto n = polynomial.size() - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  companion.row(0) = -polynomial.tail(n).transpose() / polynomial[0];
  companion.diagonal(-1).setOnes();
  return companion.eigenvalues();
}

/// Angles in (0, π) of the roots of P and Q, by the eigenvalues of their companion matrices.
Eigen::VectorXd angles(const Eigen::VectorXd& a) {
  const auto p = a.size();
  Eigen::VectorXd front = Eigen::VectorXd::Zero(p + 2);
  front[0] = 1;
  front.segment(1, p) = -a;
  std::vector<double> all;
  for (const int sign : {1, -1})
    for (const auto& z : roots(front + sign * front.reverse()))
      if (std::arg(z) > 1e-5 && std::arg(z) < pi - 1e-5) all.push_back(std::arg(z));
  std::sort(all.begin(), all.end());
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Eigen::VectorXd lsf_of(const Eigen::VectorXd& a) {
  Eigen::VectorXd lsf(a.size());
  LineSpectrum{}(a, lsf);
  return lsf;
}

Eigen::VectorXd back(const Eigen::VectorXd& lsf) {
  Eigen::VectorXd a(lsf.size());
  predictor_of(lsf, a);
  return a;
}

Track track(const Eigen::MatrixXd& values) {
  Track t;
  t.values = values;
  return t;
}

TEST(Lsf, AreTheAnglesOfTheRootsOfPAndQ) {
  Random random(1);
  for (const int order : {1, 2, 3, 8, 9, 16, 20, 21, 30})
    for (int n = 0; n < 50; ++n) {
      const Eigen::VectorXd a = stable_predictor(order, 0.8, random), expected = angles(a);
      ASSERT_EQ(expected.size(), order);
      EXPECT_LT((lsf_of(a) - expected).cwiseAbs().maxCoeff(), 1e-10) << order;
    }
}

TEST(Lsf, ComeBackAsThePredictor) {
  Random random(2);
  for (const int order : {1, 2, 3, 9, 10, 20, 21})
    for (int n = 0; n < 50; ++n) {
      const Eigen::VectorXd a = stable_predictor(order, 0.9, random);
      EXPECT_LT((back(lsf_of(a)) - a).cwiseAbs().maxCoeff(), 1e-12 * (1 + a.cwiseAbs().maxCoeff())) << order;
    }
}

TEST(Lsf, AreEvenlySpacedForAFlatSpectrum) {
  Context context;
  for (const int order : {1, 2, 19, 20}) {
    const Eigen::VectorXd lsf = Lsf{}(track(Eigen::MatrixXd::Zero(3, order)), context).values.row(1);
    for (int k = 1; k <= order; ++k) EXPECT_NEAR(lsf[k - 1], k * pi / (order + 1), 1e-14);
  }
}

// One resonance: A = 1 - 2 r cos θ z^-1 + r² z^-2 has P = (1 + z^-1)(1 - 2 c z^-1 + z^-2).
TEST(Lsf, FollowTheClosedFormOfOneResonance) {
  for (const double radius : {0.1, 0.9, 0.999999, 1 - 1e-12})
    for (const double angle : {0.02, 0.7, pi / 2, 3.1}) {
      const Eigen::VectorXd lsf = lsf_of(Eigen::Vector2d(2 * radius * std::cos(angle), -radius * radius));
      const double first = 2 * radius * std::cos(angle) + 1 - radius * radius,
                   second = 2 * radius * std::cos(angle) - 1 + radius * radius;
      // As well as a double can say: 1e-16 in cos ω is so much in ω.
      const double exact = 1e-15 / std::sin(angle) + 1e-15;
      EXPECT_NEAR(lsf[0], std::acos(first / 2), 10 * exact);
      EXPECT_NEAR(lsf[1], std::acos(second / 2), 10 * exact);
    }
}

TEST(Lsf, AreFoundHoweverNearTheyAre) {
  for (const double margin : {1e-3, 1e-6, 1e-9, 1e-12})
    for (const double angle : {0.3, pi / 8, 2.0}) {
      // Two resonances on top of each other, 20 coefficients.
      std::complex<double> z = std::polar(1 - margin, angle);
      Eigen::VectorXd polynomial = Eigen::VectorXd::Zero(21);
      polynomial[0] = 1;
      for (int n = 0; n < 2; ++n)
        for (int j = 20; j > 0; --j)
          polynomial[j] += -2 * z.real() * polynomial[j - 1] + (j > 1 ? std::norm(z) * polynomial[j - 2] : 0);
      const Eigen::VectorXd lsf = lsf_of(-polynomial.tail(20));
      int near = 0;
      for (int k = 0; k < 20; ++k) {
        if (k > 0) {
          EXPECT_GE(lsf[k], lsf[k - 1]);
        }
        near += std::abs(lsf[k] - angle) < 3 * std::sqrt(margin) + 1e-3;
      }
      EXPECT_GE(near, 4) << margin << " " << angle;
      EXPECT_GT(lsf[0], 0);
      EXPECT_LT(lsf[19], pi);
    }
}

TEST(Lsf, RootsOutsideAreMirroredWithAWarning) {
  // Roots at 2 and ½ e^±j: 2 becomes ½.
  const std::complex<double> z = std::polar(0.5, 1.0);
  const auto cubic = [&](double real) {
    return Eigen::Vector3d(real + 2 * z.real(), -(std::norm(z) + 2 * real * z.real()), real * std::norm(z));
  };
  int warnings = 0;
  Context context;
  context.on_warning = [&](std::string_view) { ++warnings; };
  Eigen::MatrixXd both(2, 3);
  both << cubic(2).transpose(), cubic(0.5).transpose();
  const Track lsf = Lsf{}(track(both), context), k = Reflection{}(track(both), context);
  EXPECT_EQ(warnings, 2);
  EXPECT_TRUE(lsf.values.row(0).isApprox(lsf.values.row(1), 1e-12));
  EXPECT_TRUE(k.values.row(0).isApprox(k.values.row(1), 1e-12));
  Reflection{}(track(both.bottomRows(1)), context);
  EXPECT_EQ(warnings, 2);
  // A root on the circle is drawn in.
  const Eigen::VectorXd on = minimum_phase(Eigen::Vector2d(2 * std::cos(1.0), -1));
  EXPECT_LT(roots(Eigen::Vector3d(1, -on[0], -on[1])).cwiseAbs().maxCoeff(), 1);
  EXPECT_NEAR(on[0], 2 * std::cos(1.0), 1e-8);
  EXPECT_TRUE(minimum_phase(Eigen::Vector3d(1e200, 1, 1e200)).allFinite());
}

TEST(Lsf, RefusesWhatIsNotFinite) {
  Context context;
  const Track broken = track(Eigen::MatrixXd::Constant(1, 4, NAN));
  EXPECT_THROW(Lsf{}(broken, context), std::runtime_error);
  EXPECT_THROW(FromLsf{}(broken), std::runtime_error);
  EXPECT_THROW(Reflection{}(broken, context), std::runtime_error);
  EXPECT_EQ(Lsf{}(track(Eigen::MatrixXd(0, 4)), context).frames(), 0);
}

TEST(FromLsf, SortsAndKeepsApart) {
  Eigen::VectorXd lsf(5);
  lsf << 1, 0.5, 0.51, 3.3, -2;
  keep_apart(0.1, lsf);
  Eigen::VectorXd expected(5);
  expected << 0.1, 0.5, 0.6, 1, pi - 0.1;
  EXPECT_TRUE(lsf.isApprox(expected, 1e-14)) << lsf;
  EXPECT_THROW(FromLsf{0.6}(track(lsf.transpose())), std::invalid_argument);
  Random random(3);
  Eigen::MatrixXd wild(100, 20);
  for (auto& x : wild.reshaped()) x = random.uniform(-1, 4);
  const Track a = FromLsf{.spacing = 0.04}(track(wild));
  for (int t = 0; t < 100; ++t) {
    Eigen::VectorXd k(20);
    EXPECT_TRUE(step_down(a.values.row(t).transpose(), k));
  }
}

TEST(Reflection, AreTheLastCoefficientsOfEachOrder) {
  Random random(4);
  Context context;
  for (const int order : {1, 2, 20}) {
    Eigen::VectorXd k(order);
    for (auto& x : k) x = random.uniform(-0.95, 0.95);
    EXPECT_LT(
        (Reflection{}(track(step_up(k).transpose()), context).values.row(0).transpose() - k).cwiseAbs().maxCoeff(),
        1e-9);
  }
  LinearPrediction p;
  Eigen::VectorXd r(21);
  for (int m = 0; m <= 20; ++m) r[m] = std::pow(0.9, m) * std::cos(0.6 * m) + 0.3 * std::pow(0.99, m);
  levinson(r, p);
  EXPECT_LT(
      (Reflection{}(track(p.a.transpose()), context).values.row(0).transpose() - p.reflection).cwiseAbs().maxCoeff(),
      1e-9);
}

}  // namespace
}  // namespace talkgraph
