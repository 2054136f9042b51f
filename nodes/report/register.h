#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_report(Registry& registry);

}  // namespace talkgraph
