#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Takes each sequence's mean off, per dimension (Eqn 3.36): over all its
/// frames but lost ones, pauses included. Throws std::runtime_error on NaN, and
/// where there is no frame that is not lost.
struct MeanCenter {
  struct Out {
    Track centred;  ///< T × D
    Track mean;     ///< 1 × D
  };
  Out operator()(const Track& track) const;
};
void describe(Description<MeanCenter>& d);

}  // namespace talkgraph
