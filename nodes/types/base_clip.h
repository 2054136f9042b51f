#pragma once

#include "nodes/types/face_track.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// A real clip with the face found in it, which a synthesised face is drawn upon.
struct BaseClip {
  Video frames;
  FaceTrack track;
};
template <>
inline constexpr PortType port_type<BaseClip>{"BaseClip", 1};
void fields(Archive& ar, BaseClip& b);

}  // namespace talkgraph
