#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Takes each sequence's mean off, per dimension (Eqn 3.36): over all its
/// frames, pauses included, or over those that `usable` marks. Throws
/// std::runtime_error on NaN, without a usable frame, and where mask and track
/// differ by more than two frames.
struct MeanCenter {
  struct Out {
    Track centred;  ///< T × D
    Track mean;     ///< 1 × D
  };
  Out operator()(const Track& track, const Mask* usable) const;
};
void describe(Description<MeanCenter>& d);

}  // namespace talkgraph
