#include "nodes/corpus/register.h"

#include "nodes/corpus/files.h"
#include "nodes/corpus/grid.h"
#include "nodes/corpus/inspect.h"
#include "nodes/corpus/manifest.h"
#include "nodes/corpus/parts.h"
#include "nodes/corpus/pick.h"
#include "nodes/corpus/pick_track.h"
#include "nodes/corpus/select.h"
#include "nodes/corpus/splits.h"
#include "nodes/corpus/thin.h"

namespace talkgraph {

void register_corpus(Registry& registry) {
  registry.add<Grid>();
  registry.add<Inspect>();
  registry.add<Manifest>();
  registry.add<SoundFiles>();
  registry.add<Pick>();
  registry.add<PickTrack>();
  registry.add<Select>();
  registry.add<Splits>();
  registry.add<Thin>();
  registry.add<Parts>();
}

}  // namespace talkgraph
