#pragma once

#include <Eigen/Core>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/ppca.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The likeliest PPCA, in closed form. Directions without variance have zero loadings, so d may exceed the rank of Y.
Ppca fit_ppca(const Eigen::MatrixXd& y, Eigen::Index d);

/// Canonical correlation analysis (Hotelling 1936): pairs of directions w, v of greatest correlation wᵀYᵀZv with
/// wᵀYᵀYw = vᵀZᵀZv = 1 of the centred streams (Eqn 4.50, which ends in ZᵀY).
struct Cca {
  Eigen::RowVectorXd mean_y, mean_z;
  Eigen::MatrixXd directions_y, directions_z;  ///< D × d; zero beyond the smaller rank
  Eigen::VectorXd correlations;                ///< falling, in [0, 1]
};
/// By singular values of orthonormal bases of both streams (Björck and Golub 1973): fewer frames than dimensions and
/// constant columns are answered within the space in which the data vary. N × D_Y and N × D_Z; N ≥ 1.
Cca fit_cca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d);

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
  /// ln p(y, z) of every row. Throws std::runtime_error if the streams determine each other (a correlation of 1).
  Eigen::VectorXd log_likelihood(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const;
};
/// In closed form. Each covariance Σ is taken as (1 − ρ)Σ + ρ·mean variance·I with
/// ρ = D / (D + N) · `shrinkage`: exact for many frames, and finite for fewer
/// frames than dimensions or constant columns. Dimensions beyond the smaller
/// stream's have correlation and loadings zero. N × D_Y and N × D_Z; N ≥ 1.
Pcca fit_pcca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d, double shrinkage = 1);

/// Probabilistic principal components of the measured frames of all tracks. Throws std::runtime_error, naming the
/// track, if none has a measured frame, on different dimensions and on values that are not finite.
struct TrainPpca {
  int latent_dimension = 2;

  Ppca operator()(const Collected<Track>& tracks, Context& context) const;
};
void describe(Description<TrainPpca>& d);

/// Posterior means of a track's latent points, T × d; lost frames stay marked.
struct ProjectPpca {
  Track operator()(const Ppca& model, const Track& track) const;
};
void describe(Description<ProjectPpca>& d);

}  // namespace talkgraph
