#pragma once

#include <vector>

#include "nodes/mapping/context_gp.h"
#include "nodes/mapping/context_utterances.h"

namespace talkgraph {

/// A process that lacks its weights, and what they are learnt from.
struct ContextTraining {
  ContextGp model;  ///< with the kernel that the node gives
  std::vector<ContextUtterance> utterances;
  std::vector<Eigen::Index> rows;  ///< of `model.frames` that are learnt, N
  Eigen::MatrixXd targets;         ///< N × D, their visual parameters less the mean
};
/// Errors of TrainContextGp.
ContextTraining context_training(const TrainContextGp& node, const Collected<Track>& audio,
                                 const Collected<PhoneTrack>& phones, const Collected<Track>& visual);

/// These, or `most` of them at even distances.
std::vector<Eigen::Index> thinned(const std::vector<Eigen::Index>& rows, int most);

}  // namespace talkgraph
