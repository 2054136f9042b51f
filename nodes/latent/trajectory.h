#pragma once

#include <Eigen/Core>
#include <vector>

#include "nodes/latent/sequences.h"

namespace talkgraph {

/// Frames z_t beside their velocities z_t − z_{t−1} and, of order 2, accelerations z_{t−1} − 2 z_t + z_{t+1}: N × D
/// to N × D (1 + order). Beyond the ends of a sequence its first and last frame go on.
Eigen::MatrixXd with_changes(const Sequences& data, int order);

/// Gaussians of K states over frames and their changes, in D (1 + order) dimensions.
struct TrajectoryStates {
  Eigen::MatrixXd means;                     ///< K × D (1 + order)
  std::vector<Eigen::MatrixXd> covariances;  ///< K of them, or their diagonals, one column each
  int order;                                 ///< 1: velocities; 2: accelerations too
};

/// The frames, T × D, that maximise Σ_t ln N(with_changes(frames)_t | state path_t): the solution of one linear system
/// whose matrix has a band of 1 + order blocks of D × D (Tokuda, Yoshimura, Masuko, Kobayashi
/// and Kitamura 2000). Throws std::runtime_error if a covariance is not positive definite.
Eigen::MatrixXd likeliest_trajectory(const TrajectoryStates& states, const std::vector<Eigen::Index>& path);

}  // namespace talkgraph
