#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_speaker(Registry& registry);

}  // namespace talkgraph
