#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_speech(Registry& registry);

}  // namespace talkgraph
