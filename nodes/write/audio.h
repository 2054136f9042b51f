#pragma once

#include <string>

#include "graph/description.h"
#include "nodes/media/audio_file.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes sound as a mono WAV file FOLDER/PREFIX+item+SUFFIX.wav below the run
/// folder. Integer formats clip at full scale.
struct WriteAudio {
  std::string folder = "sound";
  std::string prefix, suffix;
  WavFormat format = WavFormat::pcm16;

  Artifact operator()(const Audio& audio, Context& context) const;
};
void describe(Description<WriteAudio>& d);

}  // namespace talkgraph
