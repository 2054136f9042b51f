#pragma once

#include "graph/description.h"
#include "nodes/types/face_track.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The appearance parameters c of a tracked clip, T × modes.
struct FaceParameters {
  Track operator()(const FaceTrack& track) const;
};
void describe(Description<FaceParameters>& d);

}  // namespace talkgraph
