#pragma once

#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/shape.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The shapes of appearance parameters in the model frame: free of head pose,
/// in pixels of the mean shape, none (nan) in lost frames. Throws
/// std::runtime_error if the track has another dimension than the model.
struct FaceShapes {
  LandmarkTrack operator()(const AppearanceModel& model, const Track& parameters) const;
};
void describe(Description<FaceShapes>& d);

/// Throws std::runtime_error unless the track's dimension is the model's.
void check_dimension(const AppearanceModel& model, const Track& parameters);

}  // namespace talkgraph
