#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/latent/normal.h"
#include "nodes/types/coupled_hmm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// A coupled hidden Markov model of sound and face (Xie & Liu 2007), by exact expectation maximisation. The sound's
/// velocities and accelerations (`changes` 2) are beside its frames; both streams are scaled.
/// Streams are paired by key; every run of measured visual frames is a sequence. Throws std::runtime_error if none
/// pair, if lengths differ by more than two frames, on different dimensions, on values that are not finite, and if no
/// visual frame is measured.
struct TrainCoupledHmm {
  int audio_states = 20;
  int visual_states = 20;
  int mixture = 1;
  int changes = 2;
  CovarianceKind covariance = CovarianceKind::diagonal;
  double floor = 1e-2;
  double prior = 0.1;
  int iterations = 50;
  double tolerance = 1e-3;

  CoupledHmm operator()(const Collected<Track>& audio, const Collected<Track>& visual, Random& random,
                        Context& context) const;
};
void describe(Description<TrainCoupledHmm>& d);

}  // namespace talkgraph
