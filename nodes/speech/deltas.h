#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Slope of each dimension by linear regression over ±`window` frames, per
/// frame, as HTK has it: d_t = Σ θ (c_{t+θ} - c_{t-θ}) / (2 Σ θ²), θ = 1..window
/// (T × D). The first and last frame are repeated beyond the ends. Deltas of
/// deltas are double deltas.
struct Deltas {
  int window = 2;

  Track operator()(const Track& track) const;
};
void describe(Description<Deltas>& d);

}  // namespace talkgraph
