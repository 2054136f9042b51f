#include "nodes/latent/kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "graph/archive.h"
#include "nodes/latent/cholesky.h"
#include "nodes/latent/objective.h"
#include "nodes/latent/rbf_loops.h"
#include "nodes/latent/triangular.h"
#include "tests/nodes/latent/textbook.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::gaussian;

const Kernel everything{{RbfTerm{1.3, 0.7}, LinearTerm{0.4}, ArdTerm{0.8, Eigen::Vector3d(0.5, 1.5, 3)}, BiasTerm{0.2},
                         WhiteTerm{0.3, 0.1}, RbfTerm{0.5, 4}}};

TEST(Kernel, MatrixAndDiagonalFollowTheFormulas) {
  const auto a = gaussian(5, 3, 1), b = gaussian(4, 3, 2);
  KernelMatrix k;
  EXPECT_TRUE(k.compute(everything, a, b).isApprox(testing::textbook_matrix(everything, a, b), 1e-13));
  Eigen::VectorXd d(5);
  diagonal(everything, a, d);
  EXPECT_TRUE(d.isApprox(testing::textbook_matrix(everything, a, a).diagonal(), 1e-13));
  EXPECT_DOUBLE_EQ(white_variance(everything), 0.3);
}

TEST(Kernel, LogParametersComeBack) {
  Kernel copy = everything;
  const Eigen::VectorXd logs = log_parameters(everything);
  ASSERT_EQ(logs.size(), 11);
  EXPECT_EQ(parameter_names(everything),
            (std::vector<std::string>{"rbf_variance", "inverse_width", "linear", "ard_variance", "inverse_width_1",
                                      "inverse_width_2", "inverse_width_3", "bias", "white", "rbf_variance",
                                      "inverse_width"}));
  set_log_parameters(copy, logs);
  EXPECT_NEAR(white_variance(copy), 0.3, 1e-15);
  EXPECT_TRUE(log_parameters(copy).isApprox(logs, 1e-14));
}

TEST(Kernel, IsTheSameAfterSavingAndLoading) {
  const test::TemporaryFolder folder;
  Kernel saved = everything, loaded;
  write_hdf5(folder.file("kernel.h5"), [&](Archive& ar) { fields(ar, saved); });
  fields(*hdf5_reader(folder.file("kernel.h5")), loaded);
  ASSERT_EQ(loaded.terms.size(), everything.terms.size());
  const auto a = gaussian(4, 3, 1), b = gaussian(3, 3, 2);
  EXPECT_EQ(KernelMatrix().compute(loaded, a, b), KernelMatrix().compute(everything, a, b));
  EXPECT_EQ(white_variance(loaded), 0.3);
  EXPECT_EQ(log_parameters(loaded), log_parameters(everything));
}

TEST(Kernel, RefusesWidthsOfOtherDimensions) {
  EXPECT_THROW(KernelMatrix().compute(everything, gaussian(4, 2, 1), gaussian(3, 2, 2)), std::invalid_argument);
}

TEST(Kernel, IsAsAccurateFarFromTheOrigin) {
  const Kernel kernel{{RbfTerm{1, 1}}};
  Eigen::MatrixXd a(2, 1), b(1, 1);
  a << 1e8, 1e8 + 1;
  b << 1e8;
  const Eigen::MatrixXd k = KernelMatrix().compute(kernel, a, b);
  EXPECT_EQ(k(0, 0), 1);
  EXPECT_NEAR(k(1, 0), std::exp(-0.5), 1e-15);
}

TEST(RbfLoops, ExponentialIsWithinTwoUnitsOfTheLastPlace) {
  constexpr Eigen::Index n = 20011;
  const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(n, 0, std::sqrt(708.0));
  Eigen::VectorXd values(n), sums = Eigen::VectorXd::Ones(n);
  const double width = 2, origin = 0;
  rbf::values(1, &width, 1, a.data(), n, n, &origin, values.data(), sums.data());
  double worst = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const long double exact = std::exp(-static_cast<long double>(a[i] * a[i]));
    const double unit = std::nextafter(values[i], 1) - values[i];
    worst = std::max(worst, static_cast<double>(std::abs(values[i] - exact)) / std::max(unit, 1e-320));
    EXPECT_EQ(sums[i], 1 + values[i]);
  }
  EXPECT_LE(worst, 2);
}

TEST(RbfLoops, DoesNotHangOnPlaceInAVectorAndPassesNotANumberOn) {
  const Eigen::VectorXd a = gaussian(37, 1, 1);
  const double width = 0.7, origin = 0.3;
  Eigen::VectorXd all(37), sums(37);
  rbf::values(1.5, &width, 1, a.data(), 37, 37, &origin, all.data(), sums.data());
  for (Eigen::Index i = 0; i < 37; ++i) {
    double one = 0, sum = 0;
    rbf::values(1.5, &width, 1, a.data() + i, 37, 1, &origin, &one, &sum);
    EXPECT_EQ(one, all[i]);
  }
  const Eigen::Vector3d odd(std::nan(""), 1e200, 1e3);
  Eigen::Vector3d values, ignored;
  rbf::values(1, &width, 1, odd.data(), 3, 3, &origin, values.data(), ignored.data());
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[1], 0);
  EXPECT_EQ(values[2], 0);
}

TEST(Triangular, SolvesMultipliesAndInverts) {
  for (const Eigen::Index n : {1, 7, 33, 100}) {
    Eigen::MatrixXd l = gaussian(n, n, 1).triangularView<Eigen::Lower>();
    l.diagonal().array() = 2 + l.diagonal().array().abs();
    l.triangularView<Eigen::StrictlyLower>() = l / std::sqrt(n);
    const auto b = gaussian(12, n, 2);
    const Eigen::MatrixXd right = b.transpose(), upper = l.transpose();
    Eigen::MatrixXd x = b, inverse, used = right, product(n, 12);
    solve_transposed_right(l, x);
    EXPECT_TRUE((x * l.transpose()).isApprox(b, 1e-12));
    x = b;
    solve_right(l, x);
    EXPECT_TRUE((x * l).isApprox(b, 1e-12));
    invert_lower(l, inverse);
    x.resize(n, 12);
    solve_left(l, inverse, used, x);
    EXPECT_TRUE((l * x).isApprox(right, 1e-12));
    multiply_upper(upper, right, product);
    EXPECT_TRUE(product.isApprox(upper * right, 1e-12));
    multiply(l, right, product);
    EXPECT_TRUE(product.isApprox(l * right, 1e-12));
    EXPECT_TRUE((inverse * l).isIdentity(1e-12));
    EXPECT_TRUE(inverse.isLowerTriangular(0));
  }
}

TEST(Triangular, AddsTheLowerTriangleOfAProduct) {
  for (const Eigen::Index n : {1, 7, 33, 100}) {
    const auto a = gaussian(n, 12, 1), b = gaussian(n, 12, 2), start = gaussian(n, n, 3);
    const auto lower = [](const Eigen::MatrixXd& m) { return Eigen::MatrixXd(m.triangularView<Eigen::Lower>()); };
    Eigen::MatrixXd sum = start;
    add_lower(a, b, sum);
    EXPECT_TRUE(lower(sum).isApprox(lower(start + a * b.transpose()), 1e-12));
    add_lower(-2, a.transpose(), b.transpose(), sum);
    EXPECT_TRUE(lower(sum).isApprox(lower(start - a * b.transpose()), 1e-12));
  }
}

/// A factor of a nearly singular matrix.
TEST(Triangular, SolvesAsWellAsSubstitution) {
  const Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(60, -2, 2);
  Eigen::MatrixXd k = (-0.5 * (at.replicate(1, 60).rowwise() - at.transpose()).array().square() / 0.01).exp();
  k.diagonal().array() += 1e-10;
  const Eigen::MatrixXd l = k.llt().matrixL();
  const auto expected = gaussian(60, 3, 1);
  Eigen::MatrixXd inverse, b = l * expected, x(60, 3);
  const Eigen::MatrixXd substituted = l.triangularView<Eigen::Lower>().solve(b);
  invert_lower(l, inverse);
  solve_left(l, inverse, b, x);
  EXPECT_LT((x - expected).norm(), 10 * (substituted - expected).norm() + 1e-15);
}

/// Σ W∘k(A, B) + v·diag k(A, A) + white² as a function of A, B and the log parameters.
class Probe : public Objective {
 public:
  Probe() : weights_(gaussian(5, 4, 3)), diagonal_weights_(gaussian(5, 1, 4)) {}
  Eigen::Index size() const override { return 15 + 12 + 11; }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    const Eigen::MatrixXd a = p.head(15).reshaped(5, 3), b = p.segment(15, 12).reshaped(4, 3);
    Kernel kernel = everything;
    set_log_parameters(kernel, p.tail(11));
    Eigen::VectorXd d(5);
    diagonal(kernel, a, d);
    const double white = white_variance(kernel);
    cost = matrix_.compute(kernel, a, b).cwiseProduct(weights_).sum() + d.dot(diagonal_weights_) + white * white;
    if (!gradient) return true;
    Eigen::MatrixXd ga = Eigen::MatrixXd::Zero(5, 3), gb = Eigen::MatrixXd::Zero(4, 3);
    Eigen::VectorXd logs = Eigen::VectorXd::Zero(11);
    matrix_.gradient(kernel, a, b, weights_, ga, gb, logs);
    diagonal_gradient(kernel, a, diagonal_weights_, ga, logs);
    white_gradient(kernel, 2 * white, logs);
    gradient->resize(size());
    *gradient << ga.reshaped(), gb.reshaped(), logs;
    return true;
  }

 private:
  KernelMatrix matrix_;
  Eigen::MatrixXd weights_;
  Eigen::VectorXd diagonal_weights_;
};

TEST(Kernel, GradientsAgreeWithDifferences) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Probe probe;
    const auto check = check_gradient(probe, gaussian(probe.size(), 1, 10 + seed));
    EXPECT_TRUE(check.cost_consistent);
    EXPECT_LT(check.worst, 1e-8) << check.report();
  }
}

TEST(GradientCheck, FindsASmallWrongDerivativeBesideALargeOne) {
  struct Wrong : Objective {
    Eigen::Index size() const override { return 2; }
    bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
      cost = 300 * p[0] + 0.1 * p[1];
      if (gradient) *gradient = Eigen::Vector2d(300, 0.10001);
      return true;
    }
  } wrong;
  const auto check = check_gradient(wrong, Eigen::Vector2d(0.1, 0.2));
  EXPECT_EQ(check.where, 1);
  EXPECT_NEAR(check.worst, 1e-5 / 3, 1e-7);
}

TEST(GradientCheck, FindsAWrongDerivativeAndACostThatDependsOnAsking) {
  struct Wrong : Objective {
    Eigen::Index size() const override { return 2; }
    bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
      cost = p.squaredNorm() + (gradient ? 1e-12 : 0);
      if (gradient) *gradient = Eigen::Vector2d(2 * p[0], 2.1 * p[1]);
      return true;
    }
  } wrong;
  const auto check = check_gradient(wrong, Eigen::Vector2d(1, 3));
  EXPECT_TRUE(check.evaluated);
  EXPECT_FALSE(check.cost_consistent);
  EXPECT_EQ(check.where, 1);
  EXPECT_NEAR(check.worst, 0.05, 1e-6);
  const std::string report = check.report(1);
  EXPECT_NE(report.find("largest error 0.05 at parameter 1; the cost depends"), std::string::npos) << report;
  EXPECT_NE(report.find("analytic             6.3  numeric               6  error 0.05"), std::string::npos) << report;
  EXPECT_EQ(report.find("parameter 0 "), std::string::npos) << report;
}

TEST(Cholesky, AddsJitterToASingularMatrixAndSaysSo) {
  Cholesky c;
  c.compute(Eigen::MatrixXd::Identity(3, 3) * 4, 0, "identity");
  EXPECT_EQ(c.jitter(), 0);
  EXPECT_NEAR(c.log_determinant(), 3 * std::log(4.0), 1e-14);
  c.compute(Eigen::MatrixXd::Ones(5, 5), 0, "ones");
  EXPECT_GT(c.jitter(), 0);
  EXPECT_LE(c.jitter(), 1e-8);
}

TEST(Cholesky, DoesNotTrustAPivotOfRoundingErrors) {
  Eigen::Matrix2d nearly;
  nearly << 1, 1, 1, 1 + 2e-16;
  Cholesky c;
  c.compute(nearly, 0, "nearly singular");
  EXPECT_EQ(c.jitter(), 1e-10);
}

std::string refusal(const Eigen::MatrixXd& matrix) {
  try {
    Cholesky().compute(matrix, 0, "the covariance of nothing");
  } catch (const FactorisationError& e) {
    return e.what();
  }
  return "";
}

TEST(Cholesky, SaysWhatCannotBeFactorisedAndWhatToTry) {
  const std::string indefinite = refusal(Eigen::Vector3d(1000, -1000, 1).asDiagonal());
  for (const auto* part : {"the covariance of nothing (3 × 3)", "condition about 1e+03", "minimum_noise"})
    EXPECT_NE(indefinite.find(part), std::string::npos) << indefinite;
  Eigen::MatrixXd nan = Eigen::MatrixXd::Identity(2, 2);
  nan(1, 0) = std::nan("");
  EXPECT_NE(refusal(nan).find("entry (1, 0) is nan"), std::string::npos) << refusal(nan);
}

}  // namespace
}  // namespace talkgraph
