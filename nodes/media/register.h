#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_media(Registry& registry);

}  // namespace talkgraph
