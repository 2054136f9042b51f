#pragma once

#include "graph/description.h"
#include "nodes/types/coupled_hmm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The face that sound moves, by Baum-Welch inversion (Xie & Liu 2007): expectation maximisation over the visual frames
/// given those of the sound, from the states that the sound alone makes likely. Frames of the sound that are lost count
/// as not heard. By default it is left there: on the validation clips of GRID s1 each further iteration draws the
/// frames to means of states. Throws std::runtime_error on another audio dimension than the model's, and on values that
/// are not finite. No frames give no frames.
struct SynthesiseCoupledHmm {
  int iterations = 0;

  Track operator()(const CoupledHmm& model, const Track& audio) const;
};
void describe(Description<SynthesiseCoupledHmm>& d);

}  // namespace talkgraph
