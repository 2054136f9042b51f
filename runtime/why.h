#pragma once

#include <optional>
#include <string>

#include "runtime/forecast.h"

namespace talkgraph {

/// What a graph was when it ran: the recipes and wires of its nodes, the items of its sources. Kept in the cache, one a
/// graph file, so that the next run can be compared with it.
Json snapshot(const Graph& graph, const Forecast& forecast);
void keep_snapshot(const Cache& cache, const Graph& graph, const Json& snapshot);
/// Null where the graph never ran with this cache.
Json last_snapshot(const Cache& cache, const Graph& graph);

/// What a run would do at each node whose results are kept, and because of what: for all nodes, or for one, with its
/// items. Throws std::invalid_argument if there is no such node.
std::string explain(const Graph& graph, const Forecast& forecast, const Json& before,
                    const std::optional<std::string>& node = {});

}  // namespace talkgraph
