#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Zero-phase low-pass: a Butterworth filter of order 2 run forwards and
/// backwards, so the gain at the cutoff is ½ and there is no delay. Ends are
/// continued by odd reflection. A cutoff at or above half the rate does
/// nothing, and neither does a track of fewer than three frames. docs/method.md §5.
struct Lowpass {
  double cutoff =
      6;  ///< Hz, chosen on validation clips of GRID s1: 8 steps more where segments meet, 5 closes lips less

  Track operator()(const Track& track) const;
};
void describe(Description<Lowpass>& d);

}  // namespace talkgraph
