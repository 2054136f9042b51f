#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/slds.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Visual features of new speech by a switching linear dynamical system of its phones. Of the face alone they are x_1 =
/// μ_π, x_t = A_π x_{t−1} + ν_π, z_t = B_π x_t; where the system gives the sound too, its states given the sound. Lost
/// audio frames count as not observed. Audio and labels may differ by two frames, of which the common ones are used; no
/// frames give no frames. Throws std::runtime_error if they differ by more, and where the system gives sound on another
/// audio dimension than its own and on values that are not finite.
struct SynthesiseSlds {
  bool smooth = true;

  Track operator()(const Slds& model, const Track& audio, const FrameLabels& labels) const;
};
void describe(Description<SynthesiseSlds>& d);

}  // namespace talkgraph
