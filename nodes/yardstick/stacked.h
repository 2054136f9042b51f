#pragma once

#include "nodes/types/track.h"
#include "nodes/types/yardsticks.h"

namespace talkgraph {

/// z-scored audio, each frame with its neighbours (T × D (2 context + 1)).
/// Throws std::runtime_error on NaN and if the dimension is not the trained one.
Eigen::MatrixXd stacked(const StackedInputs& inputs, const Track& audio);

/// What plain regression trains on.
struct StackedTraining {
  StackedInputs inputs;
  Eigen::MatrixXd audio;              ///< N × stacked, z-scored
  Eigen::MatrixXd visual;             ///< N × D
  std::vector<std::int64_t> lengths;  ///< of the sequences, which sum to N
};

/// Pairs audio and visual tracks by key. Throws std::runtime_error if none pair,
/// on NaN, and where dimensions differ or lengths do by more than two frames. Without `scale` audio stays as it is.
StackedTraining stack_training(const Collected<Track>& audio, const Collected<Track>& visual, int context,
                               bool scale = true);

}  // namespace talkgraph
