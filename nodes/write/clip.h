#pragma once

#include <string>

#include "graph/description.h"
#include "nodes/media/clip.h"
#include "nodes/types/audio.h"
#include "nodes/types/report.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Writes a clip FOLDER/PREFIX+item+SUFFIX.mp4 (H.264 + AAC) or .webm (VP9 + Opus)
/// below the run folder, 8-bit 4:2:0 with its colour space marked (BT.709 from 720
/// rows on, else BT.601). Every frame becomes one picture of duration 1 / rate; sound
/// is padded with silence or cut to the length of the picture, and resampled to 48 kHz if
/// the format does not take its rate. A side of odd length is extended by its last row or
/// column. The same input gives the same bytes. Throws std::runtime_error for a video
/// without frames or a file that cannot be written; no half-written file is left.
struct WriteClip {
  std::string folder = "clips";
  std::string prefix, suffix;
  ClipFormat format = ClipFormat::mp4;
  int crf = 18;

  Artifact operator()(const Video& video, const Audio* audio, Context& context) const;
};
void describe(Description<WriteClip>& d);

}  // namespace talkgraph
