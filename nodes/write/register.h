#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_write(Registry& registry);

}  // namespace talkgraph
