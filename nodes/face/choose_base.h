#pragma once

#include "graph/description.h"
#include "nodes/types/base_clip.h"

namespace talkgraph {

/// Picks the clip to draw upon: the one named, else of those in which the face is found in every frame for `length`
/// seconds, or for as long as in any, that with the lowest mean residual as a share of its contrast. Throws
/// std::runtime_error if the name is unknown or there is no clip.
struct ChooseBase {
  std::string key;
  double length = 2.5;  ///< seconds: a shorter one is seen to run backwards

  BaseClip operator()(const Collected<Video>& videos, const Collected<FaceTrack>& tracks) const;
};
void describe(Description<ChooseBase>& d);

}  // namespace talkgraph
