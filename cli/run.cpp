#include "cli/run.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "cli/signals.h"
#include "nodes/types/report.h"
#include "runtime/progress.h"
#include "runtime/run_folder.h"

namespace talkgraph::cli {
namespace {

/// What the cache spared.
void tell_savings(const RunResult& result) {
  std::uint64_t found = 0;
  double saved = 0;
  for (const auto& node : result.nodes) found += node.loaded, saved += node.saved;
  if (found)
    fmt::print(stderr, "{} results found in the cache, which took {} to compute\n", found, duration_text(saved));
}

Outcome execute(const Graph& graph, const RunCommand& command, std::vector<RunObserver*> observers,
                const std::filesystem::path& folder) {
  Progress progress(command.quiet);
  observers.push_back(&progress);
  const InterruptGuard guard;
  RunOptions options;
  options.threads = command.threads;
  options.executor = command.serial ? Executor::serial : Executor::flow;
  options.folder = folder;
  options.keep_going = command.keep_going;
  options.cancel = guard.flag();
  options.observers = std::move(observers);
  std::optional<Cache> cache;
  if (command.cached)
    options.cache =
        &cache.emplace(command.cache.empty() ? Cache::default_folder() : command.cache, command.cache_limit);
  try {
    Outcome outcome{success, run(graph, options)};
    if (!command.quiet) tell_savings(*outcome.result);
    if (const auto failures = outcome.result->failures.size()) {
      fmt::print(stderr, "{} failed, as said above\n", failures);
      outcome.code = failed;
    }
    return outcome;
  } catch (const Cancelled&) {
    fmt::print(stderr, "stopped\n");
    return {cancelled, {}};
  } catch (const RunError& e) {
    fmt::print(stderr, "error: {}\n", e.what());
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

Outcome run_graph(const Graph& graph, const RunCommand& command) { return execute(graph, command, {}, command.folder); }

int run_file(const std::string& file, const RunCommand& command, const Registry& registry) {
  Diagnostics diagnostics;
  const auto graph = load_graph(file, registry, diagnostics, {command.sets});
  if (!graph) {
    fmt::print(stderr, "{}\n", diagnostics.str());
    return usage;
  }
  if (!command.overwrite && std::filesystem::exists(command.folder / "run.json"))
    throw std::invalid_argument(fmt::format("{}: holds a run already; name another folder with -o, or give --overwrite",
                                            command.folder.string()));
  RunFolder folder(*graph, command.folder);
  const Outcome outcome = execute(*graph, command, {&folder}, folder.path());
  fmt::print("run folder: {}\n", folder.path().string());
  if (outcome.result) name_artifacts(*outcome.result, folder.path());
  return outcome.code;
}

}  // namespace talkgraph::cli
