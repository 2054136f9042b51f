#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/latent/normal.h"
#include "nodes/types/track.h"
#include "nodes/types/voice_puppetry.h"

namespace talkgraph {

/// Voice puppetry (Brand 1999): an entropic hidden Markov model of the face and its velocities z_t − z_{t−1}, whose
/// states are then given Gaussians of sound by the probabilities that the face gives them (Eqns 4.11, 4.12). Both
/// streams are scaled. A state that no frame is in has the Gaussian of all sound.
/// Streams are paired by key; every run of measured visual frames is a sequence. Throws std::runtime_error if none
/// pair, if lengths differ by more than two frames, on different dimensions, on values that are not finite, and if no
/// visual frame is measured.
struct TrainVoicePuppetry {
  int states = 30;
  double prior = 1;
  CovarianceKind covariance = CovarianceKind::full;
  double floor = 1e-2;
  int iterations = 100;
  double tolerance = 1e-3;

  VoicePuppetry operator()(const Collected<Track>& audio, const Collected<Track>& visual, Random& random,
                           Context& context) const;
};
void describe(Description<TrainVoicePuppetry>& d);

}  // namespace talkgraph
