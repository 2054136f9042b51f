#pragma once

#include "graph/registry.h"

namespace talkgraph {

/// Adds the node types of this family: mapping.ssgpdm, mapping.ssgpdm_synthesise.
void register_mapping(Registry& registry);

}  // namespace talkgraph
