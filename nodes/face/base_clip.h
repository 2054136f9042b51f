#pragma once

#include <cstdint>

#include "graph/description.h"
#include "nodes/types/base_clip.h"

namespace talkgraph {

/// The longest stretch of frames in which the face was found, the first of equals.
struct GoodRun {
  std::int64_t first = 0, length = 0;
};
GoodRun longest_good_run(const FaceTrack& track);

/// A clip with its face track, to draw upon. Throws std::runtime_error if they
/// are not of one length.
struct MakeBaseClip {
  BaseClip operator()(const Video& video, const FaceTrack& track) const;
};
void describe(Description<MakeBaseClip>& d);

}  // namespace talkgraph
