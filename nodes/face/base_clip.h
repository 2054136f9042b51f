#pragma once

#include "graph/description.h"
#include "nodes/types/base_clip.h"

namespace talkgraph {

/// A clip with its face track, to draw upon. Throws std::runtime_error if they
/// are not of one length.
struct MakeBaseClip {
  BaseClip operator()(const Video& video, const FaceTrack& track) const;
};
void describe(Description<MakeBaseClip>& d);

}  // namespace talkgraph
