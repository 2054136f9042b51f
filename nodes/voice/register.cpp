#include "nodes/voice/register.h"

#include "nodes/voice/recordings.h"
#include "nodes/voice/speak.h"

namespace talkgraph {

void register_voice(Registry& registry) {
  registry.add<Speak>();
  registry.add<SpokenRecordings>();
}

}  // namespace talkgraph
