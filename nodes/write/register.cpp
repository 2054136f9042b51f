#include "nodes/write/register.h"

#include "nodes/write/audio.h"
#include "nodes/write/clip.h"
#include "nodes/write/hdf5.h"
#include "nodes/write/labels.h"
#include "nodes/write/landmarks.h"
#include "nodes/write/plot.h"
#include "nodes/write/table.h"
#include "nodes/write/track.h"
#include "nodes/write/visemes.h"

namespace talkgraph {

void register_write(Registry& registry) {
  registry.add<WriteAudio>();
  registry.add<WriteClip>();
  registry.add<WriteHdf5>();
  registry.add<WriteLabels>();
  registry.add<WriteLandmarks>();
  registry.add<WritePlot>();
  registry.add<WritePrototypes>();
  registry.add<WriteTable>();
  registry.add<WriteTrack>();
  registry.add<WriteVisemes>();
}

}  // namespace talkgraph
