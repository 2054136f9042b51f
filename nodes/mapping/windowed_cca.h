#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/track.h"
#include "nodes/types/windowed_cca.h"

namespace talkgraph {

/// Canonical correlation analysis of windows with linear regression (Theobald and Wilkinson 2007): frames of both
/// streams, scaled to mean 0 and deviation 1, each with `context` neighbours on both sides; the `dimensions` directions
/// of audio windows that correlate most with visual ones; least squares from these variates to visual windows.
///
/// Regression to the visual variates and from them back to windows is the same, as an audio variate correlates with its
/// partner alone. Windows with a lost visual frame are not learnt from; the first and last frame are repeated beyond
/// the ends. Throws std::runtime_error, naming the track, if no window is left, if lengths differ by more than two
/// frames, on different dimensions, and on values that are not finite.
struct TrainWindowedCca {
  int context = 4;
  int dimensions = 60;

  WindowedCca operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const;
};
void describe(Description<TrainWindowedCca>& d);

/// Each frame the mean of what all windows that hold it say.
struct SynthesiseWindowedCca {
  Track operator()(const WindowedCca& model, const Track& audio) const;
};
void describe(Description<SynthesiseWindowedCca>& d);

}  // namespace talkgraph
