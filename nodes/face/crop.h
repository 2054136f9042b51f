#pragma once

#include "graph/description.h"
#include "nodes/types/shape.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// The part of every frame that holds some landmarks in all of them: their box
/// over the whole clip, wider by `margin` on each side, within the picture, with
/// even sides. Frames without landmarks do not count. Cut when read. Throws std::runtime_error if a shape lacks one of
/// the points, the scheme has no such name, there is no point, or the box lies outside the picture.
struct Crop {
  std::vector<int> points;              ///< by number
  double margin = 0.3;                  ///< share of the longer side of the box
  std::vector<std::string> names = {};  ///< groups and single points of the scheme; without points and names: all

  Video operator()(const Video& video, const LandmarkTrack& landmarks) const;
};
void describe(Description<Crop>& d);

}  // namespace talkgraph
