#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Movement faster than a cutoff made larger, as the mean of many is smaller than each of them: what smooth.lowpass at
/// `cutoff` leaves out is multiplied by `gain`. Slow changes, and offsets between speech and pauses, stay as they are.
/// Throws what smooth.lowpass throws.
struct Emphasise {
  double cutoff = 1;  ///< Hz
  double gain = 1.5;

  Track operator()(const Track& track) const;
};
void describe(Description<Emphasise>& d);

}  // namespace talkgraph
