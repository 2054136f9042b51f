#include "nodes/latent/kernel.h"

#include <gtest/gtest.h>

#include "nodes/latent/cholesky.h"
#include "nodes/latent/objective.h"
#include "tests/nodes/latent/textbook.h"

namespace talkgraph {
namespace {

using testing::gaussian;

const Kernel everything{{RbfTerm{1.3, 0.7}, LinearTerm{0.4}, BiasTerm{0.2}, WhiteTerm{0.3, 0.1}, RbfTerm{0.5, 4}}};

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
  ASSERT_EQ(logs.size(), 7);
  EXPECT_EQ(parameter_names(everything)[1], "inverse_width");
  set_log_parameters(copy, logs);
  EXPECT_NEAR(white_variance(copy), 0.3, 1e-15);
  EXPECT_TRUE(log_parameters(copy).isApprox(logs, 1e-14));
}

/// Σ W∘k(A, B) + v·diag k(A, A) + white² as a function of A, B and the log parameters.
class Probe : public Objective {
 public:
  Probe() : weights_(gaussian(5, 4, 3)), diagonal_weights_(gaussian(5, 1, 4)) {}
  Eigen::Index size() const override { return 15 + 12 + 7; }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    const Eigen::MatrixXd a = p.head(15).reshaped(5, 3), b = p.segment(15, 12).reshaped(4, 3);
    Kernel kernel = everything;
    set_log_parameters(kernel, p.tail(7));
    Eigen::VectorXd d(5);
    diagonal(kernel, a, d);
    const double white = white_variance(kernel);
    cost = matrix_.compute(kernel, a, b).cwiseProduct(weights_).sum() + d.dot(diagonal_weights_) + white * white;
    if (!gradient) return true;
    Eigen::MatrixXd ga = Eigen::MatrixXd::Zero(5, 3), gb = Eigen::MatrixXd::Zero(4, 3);
    Eigen::VectorXd logs = Eigen::VectorXd::Zero(7);
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
    EXPECT_LT(check.worst, 1e-8) << "parameter " << check.where;
  }
}

TEST(GradientCheck, FindsAWrongDerivativeAndACostThatDependsOnAsking) {
  struct Wrong : Objective {
    Eigen::Index size() const override { return 2; }
    bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
      cost = p.squaredNorm() + (gradient ? 1e-12 : 0);
      if (gradient) *gradient = 2.1 * p;
      return true;
    }
  } wrong;
  const auto check = check_gradient(wrong, Eigen::Vector2d(1, 3));
  EXPECT_TRUE(check.evaluated);
  EXPECT_FALSE(check.cost_consistent);
  EXPECT_EQ(check.where, 1);
  EXPECT_NEAR(check.worst, 0.05, 1e-6);
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

TEST(Cholesky, NamesTheMatrixThatCannotBeFactorised) {
  Cholesky c;
  try {
    c.compute(-Eigen::MatrixXd::Identity(3, 3), 0, "the covariance of nothing");
    FAIL();
  } catch (const FactorisationError& e) {
    EXPECT_NE(std::string(e.what()).find("the covariance of nothing (3 × 3"), std::string::npos);
  }
  EXPECT_THROW(c.compute(Eigen::MatrixXd::Constant(2, 2, NAN), 0, "nan"), FactorisationError);
}

}  // namespace
}  // namespace talkgraph
