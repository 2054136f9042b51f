#pragma once

#include "graph/description.h"
#include "nodes/types/frames.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Log energy of each frame, ln max(floor, Σ (scale x)²), as HTK has it (T × 1).
struct Energy {
  double scale = 32768;  ///< full scale of the samples
  double floor = 1;      ///< least energy, so that silence stays finite

  Track operator()(const Frames& frames) const;
};
void describe(Description<Energy>& d);

}  // namespace talkgraph
