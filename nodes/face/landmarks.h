#pragma once

#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// The landmarks that tracking found, picture coordinates, none (nan) in lost frames; the model tells the scheme of its
/// points.
struct FaceLandmarks {
  LandmarkTrack operator()(const FaceTrack& track, const AppearanceModel* model) const;
};
void describe(Description<FaceLandmarks>& d);

}  // namespace talkgraph
