#pragma once

#include "graph/graph.h"
#include "graph/key.h"

namespace talkgraph {

/// What the results of a node depend on, but for its inputs and its item: type and version, versions of the port types,
/// parameters with their defaults, the content of files they name, the seed where it is used, and for a node that
/// writes down how its file came about, all of that. Else not the node's name in the graph, no path, no place. Throws
/// std::runtime_error if a file that a parameter names cannot be read.
Json recipe(const Graph& graph, int node);

}  // namespace talkgraph
