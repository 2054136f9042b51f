#pragma once

#include <vector>

#include "runtime/observer.h"

namespace talkgraph {

/// Checks that every item which left a port arrived wherever the port is wired
/// to, and that every node saw every item of its domain once. Throws
/// std::logic_error that names the first node for which this is not so.
void check_books(const Graph& graph, const std::vector<NodeStats>& stats);

}  // namespace talkgraph
