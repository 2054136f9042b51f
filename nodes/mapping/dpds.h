#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/dpds.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// A deterministic process dynamical system of visual features with phones as states (Englebienne, Cootes & Rattray
/// 2007), whose labels are known: A by L-BFGS, each dimension by itself, the rest in closed form at each step. A phone
/// that begins no training sequence begins with the mean of its frames. Transitions between phones are counted, each
/// once more. Every run of measured visual frames is a sequence.
///
/// Streams are paired by key. Throws std::runtime_error if none pair, if lengths differ by more than two frames, on
/// different dimensions, on values that are not finite, and if no visual frame is measured.
struct TrainDpds {
  double bound = 0.98;
  double floor = 1e-3;
  int iterations = 100;

  Dpds operator()(const Collected<Track>& visual, const Collected<FrameLabels>& labels, Context& context) const;
};
void describe(Description<TrainDpds>& d);

}  // namespace talkgraph
