#include "nodes/speaker/register.h"

#include "nodes/speaker/builtin.h"

namespace talkgraph {

void register_speaker(Registry& registry) { registry.add<BuiltinSpeaker>(); }

}  // namespace talkgraph
