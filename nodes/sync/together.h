#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Two tracks of one utterance, cut at their ends to the frames that both have.
struct TrackPair {
  Track a, b;
};

/// Throws std::runtime_error if the tracks differ in rate, or in length by more than two frames.
struct Together {
  TrackPair operator()(const Track& a, const Track& b, Context& context) const;
};
void describe(Description<Together>& d);

}  // namespace talkgraph
