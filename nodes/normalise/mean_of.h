#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The rows of a track that are not lost.
Eigen::MatrixXd measured(const Track& track);

/// The mean of the measured rows of all tracks (1 × D): of the means of all sequences,
/// the training mean.
struct MeanOf {
  Track operator()(const Collected<Track>& tracks) const;
};
void describe(Description<MeanOf>& d);

}  // namespace talkgraph
