#pragma once

#include "graph/registry.h"

namespace talkgraph::cli {

/// Every node type this program knows.
Registry all_nodes();

}  // namespace talkgraph::cli
