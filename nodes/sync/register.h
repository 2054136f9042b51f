#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_sync(Registry& registry);

}  // namespace talkgraph
