#include "cli/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/cache.h"
#include "cli/signals.h"
#include "nodes/types/report.h"
#include "runtime/memory.h"
#include "runtime/progress.h"
#include "runtime/run_folder.h"
#include "runtime/trace.h"

namespace talkgraph::cli {
namespace {

/// Where the time went, and what the cache spared: the nodes that took longest.
void tell_summary(const Graph& graph, const RunResult& result, const MemoryWatch& memory) {
  constexpr std::size_t most = 8;
  std::vector<std::size_t> order;
  NodeStats all;
  for (std::size_t n = 0; n < result.nodes.size(); ++n) {
    const auto& stats = result.nodes[n];
    all.calls += stats.calls, all.loaded += stats.loaded, all.cpu += stats.cpu, all.saved += stats.saved;
    if (stats.cpu + stats.saved >= 0.1) order.push_back(n);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.nodes[a].cpu + result.nodes[a].saved > result.nodes[b].cpu + result.nodes[b].saved;
  });
  order.resize(std::min(order.size(), most));
  const auto line = [](const std::string& name, const NodeStats& s, std::uint64_t held) {
    fmt::print(stderr, "{:<28} {:>7} {:>9.1f} s {:>9} {:>9.1f} s {:>9}\n", name, s.calls, s.cpu, s.loaded, s.saved,
               size_text(held));
  };
  fmt::print(stderr, "{:<28} {:>7} {:>11} {:>9} {:>11} {:>9}\n", "node", "calls", "processor", "found", "spared",
             "memory");
  for (const auto n : order) line(graph.nodes[n].name, result.nodes[n], memory.most(n));
  line("all", all, peak_memory());
  fmt::print(stderr, "took {}\n", duration_text(result.wall));
}

Outcome execute(const Graph& graph, const RunCommand& command, Cache* cache, std::vector<RunObserver*> observers,
                const std::filesystem::path& folder) {
  const ProgressStyle style = command.progress.value_or(usual_style());
  // A program is told in events.
  const bool told_in_words = style != ProgressStyle::json;
  Progress progress(style);
  MemoryWatch memory;
  observers.push_back(&progress);
  observers.push_back(&memory);
  const InterruptGuard guard;
  RunOptions options;
  options.threads = command.threads;
  options.executor = command.serial ? Executor::serial : Executor::flow;
  options.folder = folder;
  options.keep_going = command.keep_going;
  options.cancel = guard.flag();
  options.observers = std::move(observers);
  options.cache = cache;
  try {
    Outcome outcome{success, run(graph, options)};
    if (told_in_words && style != ProgressStyle::quiet) tell_summary(graph, *outcome.result, memory);
    if (const auto failures = outcome.result->failures.size()) {
      if (told_in_words) fmt::print(stderr, "{} failed, as said above\n", failures);
      outcome.code = failed;
    }
    return outcome;
  } catch (const Cancelled&) {
    if (told_in_words) fmt::print(stderr, "stopped\n");
    return {cancelled, {}};
  } catch (const RunError& e) {
    if (told_in_words) fmt::print(stderr, "error: {}\n", e.what());
    return {failed, {}};
  }
}

/// Each file that the graph gives as an output; of a stream of files, the first.
void name_artifacts(const RunResult& result, const std::filesystem::path& folder) {
  for (const auto& output : result.outputs) {
    const Value value = output.stream && !output.items.empty() ? output.items.front().value : output.value;
    if (!value || value.type().type != port_type<Artifact>) continue;
    const auto& artifact = value.get<Artifact>();
    const std::string more =
        output.stream && output.items.size() > 1 ? fmt::format(" and {} more beside it", output.items.size() - 1) : "";
    fmt::print("{}: {}{}\n", artifact.title.empty() ? output.name : artifact.title, (folder / artifact.path).string(),
               more);
  }
}

}  // namespace

std::unique_ptr<Cache> open_cache(const RunCommand& command) {
  if (!command.cached) return nullptr;
  return std::make_unique<Cache>(command.cache.empty() ? Cache::default_folder() : command.cache, command.cache_limit);
}

Outcome run_graph(const Graph& graph, const RunCommand& command) {
  return execute(graph, command, open_cache(command).get(), {}, command.folder);
}

int run_file(const std::string& file, const RunCommand& command, const Registry& registry) {
  Diagnostics diagnostics;
  const auto graph = load_graph(file, registry, diagnostics, {command.sets});
  if (!graph) {
    fmt::print(stderr, "{}\n", diagnostics.str());
    return usage;
  }
  if (!command.overwrite && !command.folder.empty() && std::filesystem::exists(command.folder / "run.json"))
    throw std::invalid_argument(fmt::format("{}: holds a run already; name another folder with -o, or give --overwrite",
                                            command.folder.string()));
  const auto cache = open_cache(command);
  std::optional<Trace> trace;
  if (!command.trace.empty()) trace.emplace(command.trace);
  RunFolder folder(*graph, command.folder);
  std::vector<RunObserver*> observers = {&folder};
  if (trace) observers.push_back(&*trace);
  const Outcome outcome = execute(*graph, command, cache.get(), std::move(observers), folder.path());
  fmt::print("run folder: {}\n", folder.path().string());
  if (outcome.result) name_artifacts(*outcome.result, folder.path());
  return outcome.code;
}

}  // namespace talkgraph::cli
