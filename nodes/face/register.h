#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_face(Registry& registry);

}  // namespace talkgraph
