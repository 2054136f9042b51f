#pragma once

#include <string>

#include "graph/description.h"
#include "nodes/types/segments.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// All training sequences as the windows of one state, for one model of all of them. A lost frame of either stream is
/// NaN: a missing value for latent.mrd. Sequences are paired by key, those that one stream lacks are left out; streams
/// that differ by at most two frames are used on their common beginning.
///
/// Throws std::runtime_error if lengths differ by more, or no sequence is left.
struct Sequences {
  std::string label = "all";

  StateData operator()(const Collected<Track>& audio, const Collected<Track>& visual) const;
};
void describe(Description<Sequences>& d);

}  // namespace talkgraph
