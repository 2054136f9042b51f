#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "graph/random.h"

namespace talkgraph::testing {

inline Eigen::MatrixXd gaussian(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

/// A positive definite matrix with eigenvalues of all sizes from `least`.
inline Eigen::MatrixXd positive(Eigen::Index dims, std::uint64_t seed, double least = 0.1) {
  const Eigen::MatrixXd root = gaussian(dims, dims, seed);
  return root * root.transpose() + least * Eigen::MatrixXd::Identity(dims, dims);
}

/// ln N(x | mean, covariance) as in textbooks.
inline double log_normal_density(const Eigen::VectorXd& x, const Eigen::VectorXd& mean,
                                 const Eigen::MatrixXd& covariance) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(covariance);
  return -0.5 * (static_cast<double>(x.size()) * std::log(2 * std::numbers::pi) + std::log(std::abs(lu.determinant())) +
                 (x - mean).dot(lu.solve(x - mean)));
}

/// The largest fall from one entry to the next, as a share of what is there.
inline double largest_fall(const std::vector<double>& trace) {
  double fall = 0;
  for (std::size_t i = 1; i < trace.size(); ++i)
    fall = std::max(fall, (trace[i - 1] - trace[i]) / (1 + std::abs(trace[i])));
  return fall;
}

}  // namespace talkgraph::testing
