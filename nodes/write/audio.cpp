#include "nodes/write/audio.h"

#include "graph/output_file.h"
#include "nodes/types/item_file.h"

namespace talkgraph {

Artifact WriteAudio::operator()(const Audio& audio, Context& context) const {
  const Artifact artifact = item_file(context, folder, ".wav", "sound", prefix, suffix);
  OutputFile file(context.file(artifact.path));
  write_audio(file.part(), audio, format);
  file.finish();
  return artifact;
}

void describe(Description<WriteAudio>& d) {
  d.type("write.audio").summary("writes sound as a WAV file").sink();
  d.input("audio", "what is written").output("file", "the WAV file");
  d.param("folder", &WriteAudio::folder).doc("below the run folder");
  d.param("prefix", &WriteAudio::prefix).doc("in front of the item's name");
  d.param("suffix", &WriteAudio::suffix).doc("behind the item's name");
  d.param("format", &WriteAudio::format).doc("of the samples");
}

}  // namespace talkgraph
