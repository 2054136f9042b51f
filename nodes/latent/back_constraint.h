#pragma once

#include <Eigen/Core>

#include "nodes/latent/kernel.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

/// b(y) of every row: T × D gives T × d.
Eigen::MatrixXd latent_points(const BackConstraint& b, const ConstMatrix& y);

/// A perceptron with one layer of hidden units, which start at random (seeded), and output weights that come nearest
/// to `x` at `y` (ridge regression). y is N × D, x N × d.
BackConstraint perceptron(const ConstMatrix& y, const ConstMatrix& x, Eigen::Index hidden);
/// Kernel-based regression on all frames, its weights nearest to `x` at `y`.
BackConstraint kernel_regression(const ConstMatrix& y, const ConstMatrix& x, double inverse_width);

/// The same function of frames that are y / ratio (1 × D).
BackConstraint of_rescaled(BackConstraint b, const Eigen::RowVectorXd& ratio);

/// A back-constraint at its training frames, as a function of its parameters θ:
/// weights and bias, and those of hidden units. Its memory is used again by every computation.
class BackProjection {
 public:
  /// y is N × D.
  BackProjection(BackConstraint b, Eigen::MatrixXd y);

  Eigen::VectorXd parameters() const;
  Eigen::Index size() const;
  BackConstraint with(const Eigen::Ref<const Eigen::VectorXd>& parameters) const;
  /// Latent points, N × d.
  const Eigen::MatrixXd& compute(const Eigen::Ref<const Eigen::VectorXd>& parameters);
  /// Derivative by the parameters last computed with, given that by the latent points.
  void gradient(const ConstMatrix& x_gradient, VectorView parameters);

 private:
  BackConstraint b_, derivative_;
  Eigen::MatrixXd y_, features_, x_, inner_;
};

}  // namespace talkgraph
