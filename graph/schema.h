#pragma once

#include "graph/registry.h"

namespace talkgraph {

/// JSON Schema (draft 7, which editors know best) of graph files: node types with their ports and parameters,
/// documented, ranged, with defaults. What `check` finds beyond it: wires that lead nowhere, types of wires, cycles.
Json json_schema(const Registry& registry);

}  // namespace talkgraph
