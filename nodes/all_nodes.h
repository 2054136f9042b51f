#pragma once

#include "graph/registry.h"

namespace talkgraph {

/// Every node type of the families. Also holds OpenBLAS and OpenCV to one thread inside a node, as a run works on many
/// items beside each other.
Registry all_nodes();

}  // namespace talkgraph
