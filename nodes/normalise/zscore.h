#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Mean and standard deviation of each dimension over the measured rows of all tracks,
/// one row each (2 × D); the deviation of a dimension that does not vary is 0.
struct ZscoreLearn {
  Track operator()(const Collected<Track>& tracks) const;
};
void describe(Description<ZscoreLearn>& d);

/// (x - mean) / deviation per dimension, with what normalise.zscore_learn
/// learnt; 0 where the deviation is 0.
struct ZscoreApply {
  Track operator()(const Track& track, const Track& statistics) const;
};
void describe(Description<ZscoreApply>& d);

}  // namespace talkgraph
