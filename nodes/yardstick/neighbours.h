#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"
#include "nodes/types/yardsticks.h"

namespace talkgraph {

/// Keeps all training frames: z-scored audio with ±`context` neighbours, of which the l-th weighs exp(−(l / `width`)²)
/// in squared distances, or 1 where the width is 0. Without `scale` distances are of audio as it is, such as z-scored
/// features joined to weighted indicators of phones.
struct NeighboursTrain {
  int context = 5;
  double width = 0;
  bool scale = true;

  NeighboursModel operator()(const Collected<Track>& audio, const Collected<Track>& visual) const;
};
void describe(Description<NeighboursTrain>& d);

/// The mean of the visual frames whose audio is nearest (Euclidean) to that of
/// each frame; of all of them where there are fewer than k.
struct NeighboursPredict {
  int k = 10;

  Track operator()(const NeighboursModel& model, const Track& audio) const;
};
void describe(Description<NeighboursPredict>& d);

}  // namespace talkgraph
