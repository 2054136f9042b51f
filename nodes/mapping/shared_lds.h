#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/latent/normal.h"
#include "nodes/types/shared_lds.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// One linear dynamical system behind sound and face (Lehn-Schiøler, Hansen & Larsen 2005): expectation maximisation on
/// both streams, scaled, side by side, with independent noises. Every run of measured visual frames is a sequence.
/// Streams are paired by key. Throws std::runtime_error if none pair, if lengths differ by more than two frames, on
/// different dimensions, on values that are not finite, and if no visual frame is measured.
struct TrainSharedLds {
  int latent_dimension = 30;
  CovarianceKind covariance = CovarianceKind::full;
  double floor = 1e-3;
  int iterations = 100;
  double tolerance = 1e-5;

  SharedLds operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const;
};
void describe(Description<TrainSharedLds>& d);

}  // namespace talkgraph
