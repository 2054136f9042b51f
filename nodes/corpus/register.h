#pragma once

#include "graph/registry.h"

namespace talkgraph {

void register_corpus(Registry& registry);

}  // namespace talkgraph
