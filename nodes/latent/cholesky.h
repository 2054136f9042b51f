#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

namespace talkgraph {

/// A likelihood that cannot be computed: a matrix that is not a covariance or not finite, a noise of nought, overflow.
struct FactorisationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a message advises against too little noise.
inline constexpr const char* more_noise = "raise the least noise (minimum_noise, or the minimum of a white term)";

/// Cholesky factor of a covariance matrix. Where the matrix is not positive
/// definite to working precision (a pivot is lost in the rounding errors of its
/// diagonal entry), a share of its mean diagonal is added to the diagonal:
/// 1e-10 at first, ten times more at each trial, up to a hundredth.
class Cholesky {
 public:
  /// Factorises `matrix` + share · mean(diagonal) · I, share ≥ `jitter`. Throws
  /// FactorisationError naming `what`, its size, diagonal and conditioning, and what to try.
  void compute(const Eigen::MatrixXd& matrix, double jitter, const char* what);
  /// Lower triangular; above the diagonal it is zero.
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// The share that was added.
  double jitter() const { return jitter_; }
  double log_determinant() const { return 2 * factor_.diagonal().array().log().sum(); }
  /// Turns the derivative by what was factorised into that by the matrix it was made of, jitter included; returns
  /// what it adds to the diagonal.
  double add_jitter_gradient(Eigen::Ref<Eigen::MatrixXd> derivative) const;

 private:
  bool factorise(const Eigen::MatrixXd& matrix);
  Eigen::MatrixXd factor_;
  double jitter_ = 0;
};

}  // namespace talkgraph
