#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_normalise(Registry& registry);

}  // namespace talkgraph
