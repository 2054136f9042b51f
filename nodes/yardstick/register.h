#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_yardstick(Registry& registry);

}  // namespace talkgraph
