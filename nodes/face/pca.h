#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// Principal components of the columns of a D × N matrix.
struct Pca {
  Eigen::VectorXd mean;       ///< D
  Eigen::MatrixXd modes;      ///< D × k, unit columns, the largest entry of each positive
  Eigen::VectorXd variances;  ///< k, descending, divisor N
  double total = 0;           ///< variance of all modes, kept or not
};

/// Keeps the fewest modes that hold the share `retain` of the variance. With
/// D > N the N × N problem is solved: p_i = Z v_i / sqrt(N λ_i) (docs/method.md §2). Equal
/// columns give no modes.
Pca pca(const Eigen::MatrixXd& columns, double retain);

}  // namespace talkgraph
