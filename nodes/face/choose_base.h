#pragma once

#include "graph/description.h"
#include "nodes/types/base_clip.h"

namespace talkgraph {

/// Picks the clip to draw upon: the one named, else that with the fewest lost
/// frames and, among those, the lowest mean residual. Throws
/// std::runtime_error if the name is unknown or there is no clip.
struct ChooseBase {
  std::string key;

  BaseClip operator()(const Collected<Video>& videos, const Collected<FaceTrack>& tracks) const;
};
void describe(Description<ChooseBase>& d);

}  // namespace talkgraph
