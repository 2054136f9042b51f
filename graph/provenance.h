#pragma once

#include <string>

namespace talkgraph {

struct Graph;
class Archive;

/// How that which a node writes came about; a node asks for it as a further argument `const Provenance&` of its call
/// operator, and is then called again when it changes.
struct Provenance {
  std::string node;   ///< name of the node that asks
  std::string graph;  ///< JSON: the node and all that it depends on, resolved; it can be run again
};

Provenance provenance(const Graph& graph, int node);

/// Attributes of a file: made_by (this program and its version), node, provenance (the graph).
void note(Archive& ar, const Provenance& made);

}  // namespace talkgraph
