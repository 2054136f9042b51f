#pragma once

#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// What the model sees in a clip: its own face drawn on every frame where it
/// was found, in the light found there. Drawn when read. Throws std::runtime_error if the
/// track was made with another model or is not as long as the clip.
struct RedrawFace {
  Video operator()(const AppearanceModel& model, const FaceTrack& track, const Video& video) const;
};
void describe(Description<RedrawFace>& d);

}  // namespace talkgraph
