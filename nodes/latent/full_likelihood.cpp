#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/triangular.h"

namespace talkgraph {

void FullLikelihood::factorise(const Kernel& kernel, const ConstMatrix& x) {
  covariance_ = kernel_.compute(kernel, x, x);
  covariance_.diagonal().array() += white_variance(kernel);
  cholesky_.compute(covariance_, 0, "the covariance of the training inputs");
  note(cholesky_);
}

double FullLikelihood::evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                                GpGradient* gradient) {
  check(kernel, x, y);
  const double n = static_cast<double>(y.rows()), d = static_cast<double>(y.cols());
  factorise(kernel, x);
  const auto lower = cholesky_.factor().triangularView<Eigen::Lower>();
  whitened_ = y;
  lower.solveInPlace(whitened_);
  const double value =
      -0.5 * (n * d * std::log(2 * std::numbers::pi) + d * cholesky_.log_determinant() + whitened_.squaredNorm());
  if (gradient) {
    alpha_ = whitened_;
    lower.transpose().solveInPlace(alpha_);
    gradient->outputs = -alpha_;
    invert_lower(cholesky_.factor(), inverse_);
    g_.setZero(y.rows(), y.rows());
    g_.selfadjointView<Eigen::Lower>().rankUpdate(inverse_.transpose(), -0.5 * d);
    g_.selfadjointView<Eigen::Lower>().rankUpdate(alpha_, 0.5);
    g_.triangularView<Eigen::StrictlyUpper>() = g_.transpose();
    cholesky_.add_jitter_gradient(g_);
    white_gradient(kernel, g_.trace(), gradient->kernel);
    kernel_.gradient(kernel, x, x, g_, gradient->inputs, gradient->inputs, gradient->kernel);
  }
  check_finite(value, gradient, x, u, y);
  return value;
}

GaussianProcess FullLikelihood::posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix&,
                                          const ConstMatrix& y) {
  check(kernel, x, y);
  factorise(kernel, x);
  const auto lower = cholesky_.factor().triangularView<Eigen::Lower>();
  GaussianProcess gp;
  gp.kernel = kernel;
  gp.basis = x;
  gp.weights = y;
  lower.solveInPlace(gp.weights);
  lower.transpose().solveInPlace(gp.weights);
  invert_lower(cholesky_.factor(), inverse_);
  gp.root = inverse_.transpose();
  return gp;
}

}  // namespace talkgraph
