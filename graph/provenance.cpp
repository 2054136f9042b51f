#include "graph/provenance.h"

#include <vector>

#include "graph/archive.h"
#include "graph/graph.h"

namespace talkgraph {

Provenance provenance(const Graph& graph, int node) {
  std::vector<bool> needed(graph.nodes.size());
  needed[static_cast<std::size_t>(node)] = true;
  for (auto n = needed.size(); n-- > 0;)
    if (needed[n])
      for (const auto& wire : graph.nodes[n].inputs)
        for (const auto& source : wire.sources) needed[static_cast<std::size_t>(source.node)] = true;
  Json part = graph.resolved;
  Json outputs = Json::object();
  for (std::size_t n = 0; n < needed.size(); ++n)
    if (!needed[n]) part["nodes"].erase(graph.nodes[n].name);
  const auto& asks = graph.nodes[static_cast<std::size_t>(node)];
  for (const auto& port : asks.type->outputs) outputs[port.name] = asks.name + "." + port.name;
  part["outputs"] = std::move(outputs);
  return {asks.name, part.dump()};
}

void note(Archive& ar, const Provenance& made) {
  ar.note("", "made_by", "talkgraph " TALKGRAPH_VERSION);
  ar.note("", "node", made.node);
  ar.note("", "provenance", made.graph);
}

}  // namespace talkgraph
