#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"
#include "nodes/types/trajectory_hmm.h"

namespace talkgraph {

/// Visual features of new speech whose phones are known: states inside each phone by Viterbi on the sound, then the
/// likeliest trajectory with its slopes and curvatures (Tokuda et al. 2000). A context that training never met has the
/// Gaussians that its questions lead to: those of similar contexts; for a new phone, of phones that share its viseme if
/// training told these apart, or else of a remainder. Sound and labels may differ by two frames, of which the common
/// ones are used. Throws std::runtime_error if they differ by more, on another audio dimension than the model's and on
/// values that are not finite.
struct SynthesiseTrajectoryHmm {
  Track operator()(const TrajectoryHmm& model, const Track& audio, const FrameLabels& labels) const;
};
void describe(Description<SynthesiseTrajectoryHmm>& d);

}  // namespace talkgraph
