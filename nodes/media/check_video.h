#pragma once

#include <vector>

#include "graph/description.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// How far each frame is from the clip's median picture: the share of its area
/// that differs from it by more than `level` grey levels in some colour.
std::vector<double> strangeness(const Video& video, double level, const Context& context);

/// Marks frames that are not to be learnt from: those that the decoder complained
/// about, and those that look broken, a large share of whose area is far from the clip's
/// median picture (grey ghosts, lost blocks, black or foreign pictures). It reads the
/// whole clip. It is meant for utterances of one camera: more than half of the frames
/// must be sound, and fewer than three frames are only judged by the decoder.
struct CheckVideo {
  double level = 48;  ///< grey levels
  double area = 0.2;  ///< share of the picture

  /// The video with `damaged` filled in, ascending.
  Video operator()(const Video& video, Context& context) const;
};
void describe(Description<CheckVideo>& d);

}  // namespace talkgraph
