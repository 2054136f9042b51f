#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_model(Registry& registry);

}  // namespace talkgraph
