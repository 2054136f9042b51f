#pragma once

#include <map>
#include <string>

#include "graph/registry.h"

namespace talkgraph::cli {

/// The node types, a line each, those whose name or summary holds `word`.
/// Throws std::invalid_argument if there are none.
std::string list_nodes(const Registry& registry, const std::string& word);

/// Throws std::invalid_argument with a suggestion if there is none.
const NodeType& known_type(const Registry& registry, const std::string& name);

/// One node type whole: ports, parameters, source, an example that runs.
std::string show_node(const Registry& registry, const NodeType& type);

/// The reference in Markdown, by file name: a page a family, and README.md, which lists node types and port types.
std::map<std::string, std::string> reference_pages(const Registry& registry);

}  // namespace talkgraph::cli
