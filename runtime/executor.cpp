#include "runtime/executor.h"

#include <fmt/format.h>

#include <chrono>

#include "runtime/books.h"
#include "runtime/executors.h"

namespace talkgraph {

const RunResult::Output& RunResult::output(const std::string& name) const {
  for (const auto& o : outputs)
    if (o.name == name) return o;
  throw std::out_of_range("the graph has no output \"" + name + "\"");
}

namespace {

RunResult run_once(const Graph& graph, const RunOptions& options, Keeper* keeper) {
  const int in_flight = options.in_flight ? options.in_flight : 2 * options.threads + 2;
  const auto start = std::chrono::steady_clock::now();
  Caller caller(graph, options, keeper);
  for (auto* o : options.observers) o->started(graph);
  const auto end = [&](RunReport::Status status, std::string error) {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    const RunReport report{status, std::move(error), wall.count(), caller.stats(), caller.failures(), caller.files()};
    for (auto* o : options.observers) o->ended(report);
    return report;
  };
  try {
    auto outputs = options.executor == Executor::serial ? run_serial(graph, caller)
                                                        : run_flow(graph, caller, options.threads, in_flight);
    check_books(graph, caller.stats());
    auto report = end(RunReport::Status::finished, "");
    return {std::move(outputs), std::move(report.nodes), std::move(report.failures), report.wall};
  } catch (const Cancelled&) {
    end(RunReport::Status::cancelled, "");
    throw;
  } catch (const Cache::Damaged&) {
    throw;
  } catch (const std::exception& e) {
    end(RunReport::Status::failed, e.what());
    throw;
  }
}

/// The keeper of a run. Where it cannot be made, the run ends before its first node, and observers are told.
Keeper make_keeper(const Graph& graph, const RunOptions& options, std::function<void(std::string_view)> warn) {
  const auto end = [&](RunReport::Status status, std::string error) {
    const RunReport report{status, std::move(error), 0, std::vector<NodeStats>(graph.nodes.size()), {}};
    for (auto* o : options.observers) o->started(graph), o->ended(report);
  };
  try {
    return Keeper(graph, *options.cache, options.folder, options.cancel, std::move(warn));
  } catch (const Cancelled&) {
    end(RunReport::Status::cancelled, "");
    throw;
  } catch (const std::exception& e) {
    end(RunReport::Status::failed, e.what());
    throw;
  }
}

}  // namespace

RunResult run(const Graph& graph, const RunOptions& options) {
  if (options.threads < 1)
    throw std::invalid_argument(fmt::format("threads must be at least 1, got {}", options.threads));
  if (options.in_flight < 0)
    throw std::invalid_argument(fmt::format("in_flight must not be negative, got {}", options.in_flight));
  if (!options.cache) return run_once(graph, options, nullptr);
  const auto warn = [&](std::string_view message) {
    for (auto* o : options.observers) o->notice(message);
  };
  constexpr int most_restarts = 100;
  for (int restarts = 0; restarts <= most_restarts; ++restarts) {
    Keeper keeper = make_keeper(graph, options, warn);
    try {
      return run_once(graph, options, &keeper);
    } catch (const Cache::Damaged& e) {
      // The entry is gone. What the run kept so far is found when it starts again.
      warn(e.what());
    }
  }
  warn("the cache loses entries faster than this run can use them: it goes on without it");
  return run_once(graph, options, nullptr);
}

}  // namespace talkgraph
