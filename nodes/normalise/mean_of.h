#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The mean of the rows of all tracks (1 × D): of the means of all sequences,
/// the training mean.
struct MeanOf {
  Track operator()(const Collected<Track>& tracks) const;
};
void describe(Description<MeanOf>& d);

}  // namespace talkgraph
