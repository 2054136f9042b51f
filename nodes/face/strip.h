#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Frames of a clip in rows, each with its number, as a PNG in the run folder (Appendix D). A second clip, if given,
/// stands below the first, frame by frame, as far as both go; a phone stands under a line as long as it lasts.
/// Throws std::runtime_error if the file cannot be written or there is no frame to show.
struct FrameStrip {
  int every = 1;  ///< frames
  int columns = 10;
  int width = 160;                          ///< of one picture, pixels
  std::string label = "recorded";           ///< of the first clip's rows, where there are two
  std::string below_label = "synthesised";  ///< of the second clip's
  std::string folder = "strips";

  Artifact operator()(const Video& video, const Video* below, const FrameLabels* labels, Context& context) const;
};
void describe(Description<FrameStrip>& d);

}  // namespace talkgraph
