#pragma once

#include <Eigen/Core>

#include "graph/value.h"

namespace talkgraph {

/// Canonical correlation analysis (Hotelling 1936): pairs of directions w, v of greatest correlation wᵀYᵀZv with
/// wᵀYᵀYw = vᵀZᵀZv = 1 of the centred streams (Eqn 4.50, which ends in ZᵀY).
struct Cca {
  Eigen::RowVectorXd mean_y, mean_z;
  Eigen::MatrixXd directions_y, directions_z;  ///< D × d; zero beyond the smaller rank
  Eigen::VectorXd correlations;                ///< falling, in [0, 1]
};
template <>
inline constexpr PortType port_type<Cca>{"Cca", 1};
void fields(Archive& ar, Cca& c);

/// Probabilistic canonical correlation analysis (Bach and Jordan 2005):
/// y = mean + W_Y x + ε_Y, z = mean + W_Z x + ε_Z, x ~ N(0, I), noise of covariance Σ − WWᵀ each; W = Σ U P^½ with the
/// canonical directions U and correlations P.
struct Pcca {
  Eigen::RowVectorXd mean_y, mean_z;
  Eigen::MatrixXd covariance_y, covariance_z;  ///< Σ, D × D, regularised
  Eigen::MatrixXd directions_y, directions_z;  ///< U, D × d: unit variance of the (regularised) projections
  Eigen::MatrixXd loadings_y, loadings_z;      ///< W, D × d
  Eigen::VectorXd correlations;                ///< falling, in [0, 1]

  /// E[x | y, z] of every row, N × d: per dimension √p / (1 + p) times the sum of both projections.
  Eigen::MatrixXd posterior_mean(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const;
  /// E[x | y] and E[x | z]: √p times the projection.
  Eigen::MatrixXd posterior_mean_of_y(const Eigen::MatrixXd& y) const;
  Eigen::MatrixXd posterior_mean_of_z(const Eigen::MatrixXd& z) const;
  /// Variances of x, which are independent: (1 − p) / (1 + p) given both streams, 1 − p given one.
  Eigen::VectorXd posterior_variance() const;
  Eigen::VectorXd posterior_variance_of_one() const;
  /// ln p(y, z) of every row. Throws std::runtime_error if the streams determine each other (a correlation within
  /// 1e-9 of 1).
  Eigen::VectorXd log_likelihood(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const;
};
template <>
inline constexpr PortType port_type<Pcca>{"Pcca", 1};
void fields(Archive& ar, Pcca& p);

}  // namespace talkgraph
