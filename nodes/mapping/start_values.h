#pragma once

#include <Eigen/Core>

#include "nodes/types/sgpdm.h"

// Latent points to start a search from (thesis §4.4.3), T × d. `audio` is T × D_Y, T ≥ 1, scaled as the state's.
namespace talkgraph {

/// Of each frame that of the nearest training frame (Eqn 4.79).
Eigen::MatrixXd nearest_frames(const Sgpdm& state, const Eigen::MatrixXd& audio);

/// Those of the nearest training window, at its best offset, or stretched where it is shorter.
Eigen::MatrixXd nearest_window(const Sgpdm& state, const Eigen::MatrixXd& audio);

/// The likeliest path through the training points as states of a hidden Markov model, by Viterbi's algorithm: the
/// observations' densities are those of the audio process, the transitions' those of the dynamics (Eqns 4.81, 4.82),
/// without dynamics all alike. Of more than `most` points a random subset (seeded) serves; 0: all.
Eigen::MatrixXd likeliest_path(const Sgpdm& state, const Eigen::MatrixXd& audio, Eigen::Index most);

}  // namespace talkgraph
