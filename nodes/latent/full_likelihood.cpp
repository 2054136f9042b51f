#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

void FullLikelihood::factorise(const Kernel& kernel, const ConstMatrix& x) {
  covariance_ = kernel_.compute(kernel, x, x);
  covariance_.diagonal().array() += white_variance(kernel);
  cholesky_.compute(covariance_, 0, "the covariance of the training inputs");
  note(cholesky_);
}

double FullLikelihood::evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix&, const ConstMatrix& y,
                                GpGradient* gradient) {
  const double n = static_cast<double>(y.rows()), d = static_cast<double>(y.cols());
  factorise(kernel, x);
  const auto lower = cholesky_.factor().triangularView<Eigen::Lower>();
  whitened_ = y;
  lower.solveInPlace(whitened_);
  const double value =
      -0.5 * (n * d * std::log(2 * std::numbers::pi) + d * cholesky_.log_determinant() + whitened_.squaredNorm());
  if (!gradient) return value;

  alpha_ = whitened_;
  lower.transpose().solveInPlace(alpha_);
  gradient->outputs = -alpha_;
  inverse_.setIdentity(y.rows(), y.rows());
  lower.solveInPlace(inverse_);
  g_.resize(y.rows(), y.rows());
  g_.noalias() = (-0.5 * d) * inverse_.transpose() * inverse_;
  g_.noalias() += 0.5 * alpha_ * alpha_.transpose();
  g_.diagonal().array() += cholesky_.jitter() * g_.trace() / n;
  white_gradient(kernel, g_.trace(), gradient->kernel);
  kernel_.gradient(kernel, x, x, g_, gradient->inputs, gradient->inputs, gradient->kernel);
  return value;
}

GaussianProcess FullLikelihood::posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix&,
                                          const ConstMatrix& y) {
  factorise(kernel, x);
  const auto lower = cholesky_.factor().triangularView<Eigen::Lower>();
  GaussianProcess gp;
  gp.kernel = kernel;
  gp.basis = x;
  gp.weights = y;
  lower.solveInPlace(gp.weights);
  lower.transpose().solveInPlace(gp.weights);
  inverse_.setIdentity(y.rows(), y.rows());
  lower.solveInPlace(inverse_);
  gp.reduction.noalias() = inverse_.transpose() * inverse_;
  return gp;
}

}  // namespace talkgraph
