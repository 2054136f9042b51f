#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_smooth(Registry& registry);

}  // namespace talkgraph
