#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_phones(Registry& registry);

}  // namespace talkgraph
