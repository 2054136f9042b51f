#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

namespace talkgraph {

/// A matrix that stays indefinite whatever is added to its diagonal: not finite, or not a covariance.
struct FactorisationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Cholesky factor of a covariance matrix. Where the matrix is not positive
/// definite to working precision, a share of its mean diagonal is added to the
/// diagonal, ten times more at each trial, up to a hundredth.
class Cholesky {
 public:
  /// Factorises `matrix` + share · mean(diagonal) · I, share ≥ `jitter`. Throws
  /// FactorisationError naming `what`, the size and the range of the diagonal.
  void compute(const Eigen::MatrixXd& matrix, double jitter, const char* what);
  /// Lower triangular; above the diagonal it is zero.
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// The share that was added.
  double jitter() const { return jitter_; }
  double log_determinant() const { return 2 * factor_.diagonal().array().log().sum(); }

 private:
  bool factorise();
  Eigen::MatrixXd factor_;
  double jitter_ = 0;
};

}  // namespace talkgraph
