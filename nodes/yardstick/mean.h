#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"
#include "nodes/types/yardsticks.h"

namespace talkgraph {

/// The mean of all training frames. Throws std::runtime_error on none, on NaN,
/// and where dimensions differ.
struct MeanTrain {
  MeanModel operator()(const Collected<Track>& visual) const;
};
void describe(Description<MeanTrain>& d);

/// Predicts the training mean for every frame of the sound.
struct MeanPredict {
  Track operator()(const MeanModel& model, const Track& audio) const;
};
void describe(Description<MeanPredict>& d);

}  // namespace talkgraph
