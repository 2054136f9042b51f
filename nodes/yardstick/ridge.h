#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"
#include "nodes/types/yardsticks.h"

namespace talkgraph {

/// Ridge regression from audio features with ±`context` neighbours to visual
/// parameters: minimises ‖V - A W - 1 b‖² + λ N ‖W‖², A z-scored, b not penalised.
struct RidgeTrain {
  int context = 5;
  double lambda = 0.01;

  RidgeModel operator()(const Collected<Track>& audio, const Collected<Track>& visual) const;
};
void describe(Description<RidgeTrain>& d);

struct RidgePredict {
  Track operator()(const RidgeModel& model, const Track& audio) const;
};
void describe(Description<RidgePredict>& d);

}  // namespace talkgraph
