#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// Probabilistic principal components (Tipping and Bishop 1999), closed form.
struct Ppca {
  Eigen::RowVectorXd mean;   ///< 1 × D
  Eigen::MatrixXd loadings;  ///< W, D × d
  double noise = 0;          ///< σ²: mean of the variances left out, at least 1e-8 of the mean variance
  /// E[x | y] = (WᵀW + σ²I)⁻¹Wᵀ(y − mean) of every row, N × d.
  Eigen::MatrixXd posterior_mean(const Eigen::MatrixXd& y) const;
};
/// Directions without variance have zero loadings, so d may exceed the rank of Y.
Ppca fit_ppca(const Eigen::MatrixXd& y, Eigen::Index d);

/// Probabilistic canonical correlation analysis (Bach and Jordan 2005), closed
/// form: y = W_Y x + ..., z = W_Z x + ..., W = Σ U P^½ with the canonical
/// directions U and correlations P.
struct Pcca {
  Eigen::RowVectorXd mean_y, mean_z;
  Eigen::MatrixXd directions_y, directions_z;  ///< U, D × d: unit variance of the (regularised) projections
  Eigen::MatrixXd loadings_y, loadings_z;      ///< W, D × d
  Eigen::VectorXd correlations;                ///< falling, in [0, 1]
  /// E[x | y, z] of every row, N × d: per dimension √p / (1 + p) times the sum of both projections.
  Eigen::MatrixXd posterior_mean(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const;
};
/// Each covariance Σ is taken as (1 − ρ)Σ + ρ·mean variance·I with
/// ρ = D / (D + N) · `shrinkage`: exact for many frames, and finite for fewer
/// frames than dimensions or constant columns. Dimensions beyond the smaller
/// stream's have correlation and loadings zero. N × D_Y and N × D_Z; N ≥ 1.
Pcca fit_pcca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d, double shrinkage = 1);

}  // namespace talkgraph
