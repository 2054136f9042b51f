#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Frames of a clip in rows, each with its number and its phone, as a PNG in
/// the run folder (Appendix D). Throws std::runtime_error if the file cannot
/// be written or the clip has no frame.
struct FrameStrip {
  int every = 1;  ///< frames
  int columns = 10;
  int width = 160;  ///< of one picture, pixels
  std::string folder = "strips";

  Artifact operator()(const Video& video, const FrameLabels* labels, Context& context) const;
};
void describe(Description<FrameStrip>& d);

}  // namespace talkgraph
