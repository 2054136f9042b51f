#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_statistics(Registry& registry);

}  // namespace talkgraph
