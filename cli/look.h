#pragma once

#include <string>

#include "graph/graph.h"

namespace talkgraph::cli {

/// The node types, a line each, those whose name or summary holds `word`.
/// Throws std::invalid_argument if there are none.
std::string list_nodes(const Registry& registry, const std::string& word);

/// One node type whole: ports, parameters, source, an example to paste.
/// Throws std::invalid_argument with a suggestion if there is none.
std::string show_node(const Registry& registry, const std::string& type);

/// A graph as Graphviz text, streams drawn with thick edges, types on the edges.
/// What graph `b` does differently, a line a difference, once parameters, fragments and defaults are put in; nothing if
/// they do the same.
std::string diff_graphs(const Graph& a, const Graph& b);

std::string draw_dot(const Graph& graph);
std::string draw_mermaid(const Graph& graph);

}  // namespace talkgraph::cli
