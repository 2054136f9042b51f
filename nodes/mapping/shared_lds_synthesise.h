#pragma once

#include "graph/description.h"
#include "nodes/types/shared_lds.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Visual features of new speech by a shared linear dynamical system: its states given the sound, z = C x. Lost audio
/// frames count as not observed; no frames give no frames. Throws std::runtime_error on another audio dimension than
/// the model's and on values that are not finite.
struct SynthesiseSharedLds {
  bool smooth = false;

  Track operator()(const SharedLds& model, const Track& audio) const;
};
void describe(Description<SynthesiseSharedLds>& d);

}  // namespace talkgraph
