#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_voice(Registry& registry);

}  // namespace talkgraph
