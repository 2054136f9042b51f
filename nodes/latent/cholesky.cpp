#include "nodes/latent/cholesky.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>

namespace talkgraph {

bool Cholesky::factorise() {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(factor_);
  if (llt.info() != Eigen::Success || !(factor_.diagonal().array() > 0).all()) return false;
  factor_.triangularView<Eigen::StrictlyUpper>().setZero();
  return true;
}

void Cholesky::compute(const Eigen::MatrixXd& matrix, double jitter, const char* what) {
  if (matrix.allFinite()) {
    const double mean = matrix.diagonal().mean();
    for (jitter_ = jitter; jitter_ <= 1e-2; jitter_ = std::max(10 * jitter_, 1e-10)) {
      factor_ = matrix;
      factor_.diagonal().array() += jitter_ * mean;
      if (factorise()) return;
    }
  }
  throw FactorisationError(fmt::format(
      "{} ({} × {}, diagonal from {:.3g} to {:.3g}) cannot be factorised, even with a hundredth of its mean diagonal "
      "added: look for values that are not finite or of extreme scale, or raise minimum_noise",
      what, matrix.rows(), matrix.cols(), matrix.diagonal().minCoeff(), matrix.diagonal().maxCoeff()));
}

}  // namespace talkgraph
