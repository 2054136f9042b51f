#pragma once

#include "graph/description.h"
#include "nodes/types/dpds.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Visual features of new speech by a deterministic process dynamical system: x_1 = μ_π, x_t = A_π x_{t−1} + ν_π of its
/// phones. A phone without training frames leaves the face as it is, at the mean if it is the first. The sound gives
/// rate and start alone; it and the labels may differ by two frames, of which the common ones are used. Throws
/// std::runtime_error if they differ by more.
struct SynthesiseDpds {
  Track operator()(const Dpds& model, const Track& audio, const FrameLabels& labels) const;
};
void describe(Description<SynthesiseDpds>& d);

}  // namespace talkgraph
