#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The video frames of a sound, as a track without dimensions (T × 0): as many as the tracks have that are brought to
/// the video rate. Labels made like it depend on no speech parameter.
struct VideoFrames {
  Rational rate{25};

  Track operator()(const Audio& audio) const;
};
void describe(Description<VideoFrames>& d);

}  // namespace talkgraph
