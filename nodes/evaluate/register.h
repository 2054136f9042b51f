#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_evaluate(Registry& registry);

}  // namespace talkgraph
