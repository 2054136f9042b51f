#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/latent/normal.h"
#include "nodes/types/phones.h"
#include "nodes/types/slds.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// A switching linear dynamical system of visual features with phones as states, whose labels are known: expectation
/// maximisation with a Kalman smoother that switches with them. It starts with one linear dynamical system (latent.lds)
/// in every phone, and phones of few frames keep that. With `sound` the same states give the audio features too.
/// Every run of measured visual frames is a sequence.
///
/// Streams are paired by key. Throws std::runtime_error if none pair, if lengths differ by more than two frames, on
/// different dimensions, on values that are not finite, and if no visual frame is measured.
struct TrainSlds {
  bool sound = false;
  int latent_dimension = 5;
  CovarianceKind covariance = CovarianceKind::full;
  int min_frames = 50;
  double bound = 0.98;
  double floor = 1e-3;
  int iterations = 20;
  double tolerance = 1e-4;

  Slds operator()(const Collected<Track>& audio, const Collected<Track>& visual, const Collected<FrameLabels>& labels,
                  Context& context) const;
};
void describe(Description<TrainSlds>& d);

/// The system that gives frames of a phone.
const Lds& system_of(const Slds& model, const std::string& phone);

}  // namespace talkgraph
