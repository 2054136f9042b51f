#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// Probabilistic principal components (Tipping and Bishop 1999):
/// y = mean + W x + ε, x ~ N(0, I), ε ~ N(0, σ² I).
/// Members throw std::runtime_error if rows have another length than D.
struct Ppca {
  Eigen::RowVectorXd mean;   ///< 1 × D
  Eigen::MatrixXd loadings;  ///< W, D × d
  double noise =
      0;  ///< σ²: mean of the variances left out, at least 1e-8 of the mean variance (of 1 if nothing varies)

  /// E[x | y] = (WᵀW + σ²I)⁻¹Wᵀ(y − mean) of every row, N × d.
  Eigen::MatrixXd posterior_mean(const Eigen::MatrixXd& y) const;
  /// σ²(WᵀW + σ²I)⁻¹, d × d, the same for every row.
  Eigen::MatrixXd posterior_covariance() const;
  /// ln N(y | mean, WWᵀ + σ²I) of every row.
  Eigen::VectorXd log_likelihood(const Eigen::MatrixXd& y) const;
};
template <>
inline constexpr PortType port_type<Ppca>{"Ppca", 1};
void fields(Archive& ar, Ppca& p);

}  // namespace talkgraph
