#pragma once

#include <string>

#include "graph/graph.h"

namespace talkgraph::cli {

/// What graph `b` does differently, a line a difference, once parameters, fragments and defaults are put in; nothing if
/// they do the same.
std::string diff_graphs(const Graph& a, const Graph& b);

/// A graph as Graphviz text: streams drawn with thick edges, types on the edges, a box around each graph used as a
/// node.
std::string draw_dot(const Graph& graph);
/// The same as SVG, by Graphviz. Throws std::runtime_error if that is not there or fails.
std::string draw_svg(const Graph& graph);
/// The same in Mermaid.
std::string draw_mermaid(const Graph& graph);

}  // namespace talkgraph::cli
