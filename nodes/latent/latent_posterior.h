#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nodes/latent/kernel.h"

namespace talkgraph {

/// q(X) of N frames in windows and its divergence from the prior, as a function of free parameters (N × d each):
/// - without a width of time, p(X) = Π N(x_n; 0, I), mean = free mean, variance = 1 / (1 + precision);
/// - with one, every latent dimension of a window of T frames is a Gaussian process over time (Damianou, Titsias and
///   Lawrence 2011): p(x) = N(0, K), K_ij = (1 − ε) exp(−½(i − j)²/width²) + ε δ_ij, ε = 0.05; mean = chol(K)·free
///   mean, q(x) has the covariance (K⁻¹ + diag(precision))⁻¹, of which `variance` is the diagonal.
class LatentPosterior {
 public:
  LatentPosterior(const std::vector<std::int64_t>& lengths, double width);

  Eigen::Index rows() const { return rows_; }
  /// Parameters of given means (N × d), as mean and variance have them.
  Eigen::MatrixXd free_mean(const Eigen::MatrixXd& mean) const;
  /// Sets mean and variance of the given windows; returns their divergence KL(q ‖ p).
  double compute(const std::vector<std::size_t>& windows, const ConstMatrix& free_mean,
                 const ConstMatrix& log_precision, Eigen::MatrixXd& mean, Eigen::MatrixXd& variance) const;
  /// Turns derivatives of a bound by mean and variance of the windows into those of bound − divergence by the free
  /// parameters, in place.
  void gradient(const std::vector<std::size_t>& windows, const ConstMatrix& free_mean, const ConstMatrix& log_precision,
                Eigen::MatrixXd& by_mean, Eigen::MatrixXd& by_variance) const;

  std::size_t windows() const { return starts_.size(); }
  Eigen::Index start(std::size_t window) const { return starts_[window]; }
  Eigen::Index length(std::size_t window) const { return lengths_[window]; }

 private:
  const Eigen::MatrixXd& prior(std::size_t w) const { return priors_[static_cast<std::size_t>(lengths_[w])]; }
  const Eigen::MatrixXd& root(std::size_t w) const { return roots_[static_cast<std::size_t>(lengths_[w])]; }

  bool over_time_;
  Eigen::Index rows_ = 0;
  std::vector<Eigen::Index> starts_, lengths_;
  std::vector<Eigen::MatrixXd> priors_, roots_;  // by length: K and its Cholesky factor
};

}  // namespace talkgraph
