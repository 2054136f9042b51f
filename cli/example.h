#pragma once

#include <string>
#include <vector>

#include "graph/registry.h"

namespace talkgraph::cli {

/// A small graph that shows a node type at work, on the built-in speaker or on what `talkgraph samples` writes: the
/// node first, then what feeds it; behind it a sink, where there is one for what it gives. Types that cli/examples.json
/// does not hold, those of plug-ins, are wired to the first that gives what they take, with made-up parameters where
/// they require some. Throws std::runtime_error where that does not give a sound graph.
Json example_graph(const Registry& registry, const NodeType& type);

/// Nodes of cli/examples.json, by name, with all that they need.
Json example_nodes(const std::vector<std::string>& names);

/// Whether an example reads what `talkgraph samples` writes.
bool reads_samples(const Json& graph);

/// A graph as people write it, a node a line.
std::string graph_text(const Json& graph);

}  // namespace talkgraph::cli
