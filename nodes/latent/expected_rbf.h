#pragma once

#include <Eigen/Core>

#include "nodes/latent/kernel.h"

namespace talkgraph {

/// exp(offset_p) · E[exp(−½ Σ_q w_q (x_q − p_q)²)] for inputs x ~ N(mean, diag(variance)), in closed form:
/// Π_q (w_q s_q + 1)^−½ exp(−½ w_q (m_q − p_q)² / (w_q s_q + 1)). With zero variances it is an RBF kernel.
///
/// Its logarithm is bilinear in features of the rows and of the points, so that values and derivatives are matrix
/// products. Rows come in parts: begin, then compute and gradient of each part, then the sums over all parts.
class ExpectedRbf {
 public:
  /// Points are P × d, inverse widths d, offsets P.
  void begin(const Eigen::VectorXd& inverse_widths, const Eigen::MatrixXd& points, const Eigen::VectorXd& offsets);
  /// Values of n rows given as n × d means and variances: n × P.
  const Eigen::MatrixXd& compute(const ConstMatrix& mean, const ConstMatrix& variance);
  const Eigen::MatrixXd& value() const { return value_; }

  /// Takes in the derivative of a cost by the values last computed (n × P); adds to those by mean and variance.
  void gradient(const ConstMatrix& g, const ConstMatrix& mean, const ConstMatrix& variance, MatrixView mean_gradient,
                MatrixView variance_gradient);
  /// The same where all rows have the one derivative `g` (P).
  void row_sum_gradient(const Eigen::VectorXd& g, const ConstMatrix& mean, const ConstMatrix& variance,
                        MatrixView mean_gradient, MatrixView variance_gradient);

  Eigen::MatrixXd points_gradient() const;  ///< P × d
  Eigen::VectorXd offsets_gradient() const { return column_gradient_.rightCols(1); }
  const Eigen::VectorXd& inverse_widths_gradient() const { return width_gradient_; }

 private:
  void chain(const ConstMatrix& mean, const ConstMatrix& variance, MatrixView mean_gradient,
             MatrixView variance_gradient);

  Eigen::VectorXd widths_, width_gradient_;
  Eigen::RowVectorXd centre_;  // of the points; p and m are taken from there, so that squares do not drown differences
  Eigen::MatrixXd columns_, column_gradient_, weighted_columns_;  // P × (2d + 2): p², p, 1, offset
  Eigen::MatrixXd rows_, row_gradient_;                           // n × (2d + 2): −w/2, w·m, the rest, 1
  Eigen::MatrixXd value_, weighted_, products_;
  Eigen::ArrayXXd shrinkage_, weights_, weight_gradient_;  // n × d: 1 / (w s + 1), w / (w s + 1)
};

}  // namespace talkgraph
