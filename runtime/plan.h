#pragma once

#include <vector>

#include "graph/graph.h"

namespace talkgraph {

/// How a source reaches the node that reads it.
enum class Way {
  single,    ///< one value for the whole run
  item,      ///< the value of the item at work
  gathered,  ///< the whole stream
};
Way way(const Graph& graph, const Graph::Wire& wire, const Graph::Port& source);

/// Calls f(input port, source port, way) for everything wired to a node.
template <class F>
void for_each_source(const Graph& graph, int node, F f) {
  const auto& inputs = graph.nodes[static_cast<std::size_t>(node)].inputs;
  for (std::size_t p = 0; p < inputs.size(); ++p)
    for (const auto& source : inputs[p].sources) f(p, source, way(graph, inputs[p], source));
}

/// A graph cut into units such that within a unit no item waits for anything
/// but itself: a unit starts when the units it reads are complete. So a limit
/// on the items in flight cannot lock the run up.
struct Plan {
  /// Nodes of a sweep in a line: each waits for the one before alone, which nothing else waits for. There is
  /// nothing to gain from running them in parallel for one item.
  struct Run {
    std::vector<int> nodes;
    std::vector<int> after;  ///< the runs of the sweep that the first node waits for
  };
  /// One call of a node that runs once, or a sweep over the items of a domain.
  struct Unit {
    int domain = -1;             ///< the source whose items are swept, -1 for a single call
    bool opens = false;          ///< the first sweep of its domain draws the items from the source
    std::vector<int> nodes;      ///< in topological order, without the source
    std::vector<int> after;      ///< the units that must be complete
    std::vector<Run> runs = {};  ///< of a sweep: its nodes again
  };
  std::vector<Unit> units;  ///< in an order in which they can run one by one
  std::vector<int> unit;    ///< of each node (for a source: the sweep that opens it)
};

/// A domain is swept once where that is possible; it is swept again where nodes
/// need what was collected from it (train, then apply). What a later sweep
/// needs is then held for every item, so a sweep waits rather than holding
/// values for the sake of another domain that could come first.
Plan make_plan(const Graph& graph);

}  // namespace talkgraph
