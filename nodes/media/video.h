#pragma once

#include "graph/description.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Opens one video: a video file, a still picture (a video of one frame), or a
/// folder of PNG or JPEG pictures, which are read at `rate`. Errors as open_video and
/// open_frame_folder.
struct OpenVideo {
  FilePath file;
  Rational rate{25};

  Video operator()() const;
};
void describe(Description<OpenVideo>& d);

}  // namespace talkgraph
