#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_plot(Registry& registry);

}  // namespace talkgraph
