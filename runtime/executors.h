#pragma once

#include <vector>

#include "runtime/call.h"

namespace talkgraph {

/// The two executors give the outputs; the caller has the books.
std::vector<RunResult::Output> run_serial(const Graph& graph, Caller& caller);
std::vector<RunResult::Output> run_flow(const Graph& graph, Caller& caller, int threads, int in_flight);

}  // namespace talkgraph
