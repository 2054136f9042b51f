#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/archive.h"
#include "nodes/latent/cholesky.h"

namespace talkgraph {

/// What a bound needs to know of the rows of one stream.
struct RowStatistics {
  struct Group {  ///< outputs that the same rows have
    std::vector<Eigen::Index> outputs;
    double rows = 0;
    Eigen::MatrixXd psi2;  ///< of those rows, M × M
  };
  double squares = 0;         ///< Σ y²
  Eigen::MatrixXd projected;  ///< Ψ1ᵀY, M × D
  std::vector<Group> groups;
};

/// Derivatives of a bound, all assigned.
struct BoundGradient {
  Eigen::MatrixXd projected;          ///< M × D
  std::vector<Eigen::MatrixXd> psi2;  ///< one a group, M × M, symmetric
  Eigen::MatrixXd inducing;           ///< by k(U, U), M × M, symmetric
  double diagonal = 0;                ///< by k(x, x), which is the same for all rows
  double noise = 0;
};

/// What the rows are seen through: u = L v with L Lᵀ = k(U, U), v ~ N(0, I) a priori, one u for each output.
/// k(U, U) has `jitter` times its mean diagonal added, which is part of the model (its derivative is taken).
class InducingVariables {
 public:
  explicit InducingVariables(double jitter = 1e-6) : base_jitter_(jitter) {}
  /// Takes k(U, U), k(x, x) and the noise variance. Throws FactorisationError.
  void begin(const Eigen::MatrixXd& covariance, double diagonal, double noise);
  double diagonal() const { return diagonal_; }
  double precision() const { return 1 / noise_; }
  Eigen::Index count() const { return cholesky_.factor().rows(); }
  /// L⁻¹A and L⁻ᵀA.
  Eigen::MatrixXd whitened(Eigen::MatrixXd a) const;
  Eigen::MatrixXd unwhitened(Eigen::MatrixXd a) const;
  /// L⁻¹AL⁻ᵀ and L⁻ᵀAL⁻¹ of a symmetric A.
  Eigen::MatrixXd whitened_square(const Eigen::MatrixXd& a) const;
  Eigen::MatrixXd unwhitened_square(const Eigen::MatrixXd& a) const;
  /// Turns the derivative by k(U, U) with jitter into that without.
  void add_jitter_gradient(Eigen::MatrixXd& g) const { cholesky_.add_jitter_gradient(g); }
  double jitter() const { return cholesky_.jitter(); }

 private:
  double base_jitter_, diagonal_ = 0, noise_ = 1;
  Cholesky cholesky_;
};

/// The bound of ln p(Y) given q(X), with the best q(v) (Titsias and Lawrence 2010).
class CollapsedBound {
 public:
  double evaluate(const InducingVariables& u, const RowStatistics& rows, BoundGradient* gradient);
  /// Predictions under the best q(v): mean k(x, U)·weights (M × D), variance k(x, x) − k(x, U)·reduction·k(U, x)
  /// (M × M; the mean over outputs where groups differ).
  Eigen::MatrixXd weights(const InducingVariables& u, const RowStatistics& rows);
  Eigen::MatrixXd reduction(const InducingVariables& u, const RowStatistics& rows);

 private:
  void factorise(const InducingVariables& u, const RowStatistics& rows, const RowStatistics::Group& group);
  Cholesky inner_;
  Eigen::MatrixXd second_, a_, projected_, c_;
};

/// The bound of ln p(Y) given q(X) and a given q(v), a sum over rows, so that a part of them gives unbiased gradients
/// (Hensman, Fusi and Lawrence 2013).
class StochasticBound {
 public:
  /// Of q(v).
  friend void fields(Archive& ar, StochasticBound& bound);
  /// Moves q(v) by `step` along its natural gradient, where `scale` times the rows' terms stand for all rows: with
  /// step 1 it is the best q(v) of the rows given. At first it is the prior.
  void move(const InducingVariables& u, const RowStatistics& rows, double scale, double step);
  /// `scale` times the terms of the rows, less the divergence of q(v) from its prior.
  double evaluate(const InducingVariables& u, const RowStatistics& rows, double scale, BoundGradient* gradient);

 private:
  struct Posterior {  // of v for a group of outputs: mean M × D_g, variance the same for all
    Eigen::MatrixXd precision, precision_mean, mean, variance;
    double log_determinant = 0;  // of the precision
  };
  std::vector<Posterior> posteriors_;
};

}  // namespace talkgraph
