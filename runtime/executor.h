#pragma once

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "graph/graph.h"
#include "runtime/cache.h"
#include "runtime/observer.h"

namespace talkgraph {

/// The first failing item stopped the run.
struct RunError : std::runtime_error {
  explicit RunError(Failure f) : std::runtime_error(f.str()), failure(std::move(f)) {}
  Failure failure;
};

enum class Executor {
  flow,    ///< oneTBB flow graph: parallel, bounded in memory
  serial,  ///< node by node in one thread, whole streams in memory: what flow is tested against
};

struct RunOptions {
  int threads = 2;  ///< of the flow executor
  Executor executor = Executor::flow;
  std::filesystem::path folder = ".";  ///< files that nodes write go below it
  int in_flight = 0;                   ///< items of one source at work at the same time; 0: 2 * threads + 2
  bool keep_going = false;             ///< failed items become nothings and are listed
  const std::atomic<bool>* cancel = nullptr;
  Cache* cache = nullptr;  ///< where results are kept and found; none: all is computed
  std::vector<RunObserver*> observers;
};

struct RunResult {
  struct Output {
    std::string name;
    bool stream = false;
    Value value;                     ///< of a single output; may be empty
    std::vector<Item<Value>> items;  ///< of a stream, in the order of its source, without nothings
  };
  std::vector<Output> outputs;   ///< as in the graph
  std::vector<NodeStats> nodes;  ///< as in the graph
  std::vector<Failure> failures;
  double wall = 0;  ///< seconds

  /// Throws std::out_of_range if there is no such output.
  const Output& output(const std::string& name) const;
};

/// Runs every node of the graph. Throws RunError on
/// the first failing item unless keep_going, Cancelled if the flag was set,
/// std::invalid_argument on impossible options, std::logic_error if the books
/// of items in and out do not balance. The same graph and seed give the same
/// bits for any executor and number of threads.
RunResult run(const Graph& graph, const RunOptions& options = {});

}  // namespace talkgraph
