#pragma once

#include <Eigen/Core>

#include "nodes/latent/kernel.h"

namespace talkgraph {

/// Predictive distribution of a Gaussian process at given inputs, in scaled
/// output units: every row of the outputs is N(mean, variance·I). The variance
/// includes the noise and is never below it.
class Predictive {
 public:
  /// x is T × d.
  void compute(const GaussianProcess& gp, const ConstMatrix& x);
  const Eigen::MatrixXd& mean() const { return mean_; }          ///< T × D
  const Eigen::VectorXd& variance() const { return variance_; }  ///< T

  /// Σ_t ln N(y_t | mean, variance·I) at the inputs last computed; y is T × D.
  double log_density(const ConstMatrix& y);
  /// Adds `weight` times its derivatives with respect to x and y; takes the
  /// process and the inputs last computed, after log_density.
  void gradient(const GaussianProcess& gp, const ConstMatrix& x, double weight, MatrixView x_gradient,
                MatrixView y_gradient);

 private:
  KernelMatrix kernel_;
  Eigen::MatrixXd mean_, residual_, rooted_, reduced_, g_, basis_gradient_;
  Eigen::VectorXd variance_, variance_gradient_, weights_, logs_;
};

/// Scaled outputs in their own units, and the reverse.
Eigen::MatrixXd unscaled(const GaussianProcess& gp, const Eigen::MatrixXd& scaled);
Eigen::MatrixXd scaled(const GaussianProcess& gp, const Eigen::MatrixXd& outputs);

}  // namespace talkgraph
