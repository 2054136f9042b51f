#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Gives the mean of a process the range of motion of what it is the mean of. By the law of total variance a parameter
/// varies by the variance of its mean and the mean of its variance; so about its mean over the frames of speech it is
/// multiplied there by
///   g = ((Var_t μ + mean_t σ²) / Var_t μ)^(strength / 2).
/// The gain falls to 1 over `fade` frames beyond, so that pauses stay as they are. A parameter that does not vary, and
/// a track without speech, is left alone. Correlations with the truth over speech do not change; squared errors are
/// least at strength 0, if the process is right.
///
/// Throws std::runtime_error on values that are not finite, variances below 0, or if sizes do not agree.
struct FullRange {
  double strength = 0.6;
  int fade = 4;

  Track operator()(const Track& track, const Track& variance, const Mask& speech) const;
};
void describe(Description<FullRange>& d);

}  // namespace talkgraph
