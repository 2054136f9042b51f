#pragma once

#include "graph/description.h"
#include "nodes/types/face_track.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// The landmarks that tracking found, picture coordinates.
struct FaceLandmarks {
  LandmarkTrack operator()(const FaceTrack& track) const;
};
void describe(Description<FaceLandmarks>& d);

}  // namespace talkgraph
