#pragma once

#include <Eigen/Core>

#include "nodes/latent/expected_rbf.h"

namespace talkgraph {

/// k(a, b) = variance · exp(−½ Σ_q inverse_widths_q (a_q − b_q)²) + bias: automatic relevance determination.
struct ArdKernel {
  double variance = 1;
  double bias = 0.1;
  Eigen::VectorXd inverse_widths;  ///< d
};

/// Expectations of an ARD kernel under q(X) = Π_n N(x_n; mean_n, diag(variance_n)) (Titsias and Lawrence 2010):
/// Ψ1 = E[k(X, U)] and Ψ2 = Σ_n E[k(U, x_n) k(x_n, U)]. Rows come in parts, as in ExpectedRbf.
class PsiStatistics {
 public:
  /// `inducing` is M × d.
  void begin(const ArdKernel& kernel, const Eigen::MatrixXd& inducing);
  /// Ψ1 of n rows, n × M. With zero variances it is k(X, U).
  const Eigen::MatrixXd& first(const ConstMatrix& mean, const ConstMatrix& variance);
  /// Adds Ψ2 of the rows of the last call of first() to an M × M matrix.
  void add_second(const ConstMatrix& mean, const ConstMatrix& variance, Eigen::MatrixXd& psi2);

  /// Takes in the derivative of a cost by Ψ1 (n × M) of the last call of first(); adds to those by mean and variance.
  void first_gradient(const ConstMatrix& g, const ConstMatrix& mean, const ConstMatrix& variance,
                      MatrixView mean_gradient, MatrixView variance_gradient);
  /// The same of Ψ1 and Ψ2 (M × M, symmetric) of the last calls of first() and add_second().
  void gradient(const ConstMatrix& g1, const Eigen::MatrixXd& g2, const ConstMatrix& mean, const ConstMatrix& variance,
                MatrixView mean_gradient, MatrixView variance_gradient);

  Eigen::MatrixXd inducing_gradient() const;  ///< over all parts, M × d
  ArdKernel kernel_gradient() const;          ///< over all parts, by the parameters themselves

 private:
  ArdKernel kernel_;
  Eigen::MatrixXd inducing_;
  Eigen::MatrixXd midpoints_, differences_;  // of pairs of inducing points, M(M + 1)/2 × d
  ExpectedRbf one_, two_;
  Eigen::MatrixXd psi1_, rbf_gradient_;
  Eigen::VectorXd pair_sums_, pair_gradient_;
  Eigen::RowVectorXd sums_;
  double bias_gradient_ = 0;
};

}  // namespace talkgraph
