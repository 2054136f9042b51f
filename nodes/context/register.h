#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_context(Registry& registry);

}  // namespace talkgraph
