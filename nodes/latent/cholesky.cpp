#include "nodes/latent/cholesky.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace talkgraph {

namespace {

std::string first_not_finite(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j)
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      if (!std::isfinite(matrix(i, j))) return fmt::format("({}, {}) is {}", i, j, matrix(i, j));
  return "";
}

/// Ratio of the largest to the smallest pivot, in absolute value, of a pivoted LDLᵀ decomposition.
double condition(const Eigen::MatrixXd& matrix) {
  const Eigen::ArrayXd pivots = matrix.ldlt().vectorD().array().abs();
  return pivots.maxCoeff() / pivots.minCoeff();
}

[[noreturn]] void refuse(const Eigen::MatrixXd& matrix, const char* what) {
  const std::string size = fmt::format("{} ({} × {})", what, matrix.rows(), matrix.cols());
  if (!matrix.allFinite())
    throw FactorisationError(fmt::format(
        "{} is not finite: entry {}; look for NaN or values of extreme scale in the data, or parameters run away: "
        "scale the data, hold kernel parameters by a prior, fix them",
        size, first_not_finite(matrix)));
  throw FactorisationError(fmt::format(
      "{} is not positive definite, even with a hundredth of its mean diagonal added (diagonal from {:.3g} to {:.3g}, "
      "condition about {:.1g}): {}, look for repeated points, or lower the number of inducing points",
      size, matrix.diagonal().minCoeff(), matrix.diagonal().maxCoeff(), condition(matrix), more_noise));
}

}  // namespace

bool Cholesky::factorise(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(factor_);
  if (llt.info() != Eigen::Success) return false;
  const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(matrix.rows());
  if (!(factor_.diagonal().array().square() > rounding * matrix.diagonal().array()).all()) return false;
  factor_.triangularView<Eigen::StrictlyUpper>().setZero();
  return true;
}

void Cholesky::compute(const Eigen::MatrixXd& matrix, double jitter, const char* what) {
  if (matrix.allFinite()) {
    const double mean = matrix.diagonal().mean();
    for (jitter_ = jitter; jitter_ <= 1e-2; jitter_ = std::max(10 * jitter_, 1e-10)) {
      factor_ = matrix;
      factor_.diagonal().array() += jitter_ * mean;
      if (factorise(matrix)) return;
    }
  }
  refuse(matrix, what);
}

double Cholesky::add_jitter_gradient(Eigen::Ref<Eigen::MatrixXd> derivative) const {
  const double share = jitter_ * derivative.trace() / static_cast<double>(derivative.rows());
  derivative.diagonal().array() += share;
  return share;
}

}  // namespace talkgraph
