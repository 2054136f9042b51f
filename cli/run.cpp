#include "cli/run.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <memory>

#include "nodes/types/report.h"
#include "runtime/progress.h"
#include "runtime/run_folder.h"

namespace talkgraph::cli {
namespace {

std::atomic<bool> interrupted{false};

/// Ctrl-C asks the run to stop; a second one ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard() : before_(std::signal(SIGINT, handle)) { interrupted = false; }
  ~InterruptGuard() { std::signal(SIGINT, before_); }

 private:
  static void handle(int) {
    interrupted = true;
    std::signal(SIGINT, SIG_DFL);
  }
  void (*before_)(int);
};

Outcome execute(const Graph& graph, const RunCommand& command, std::vector<RunObserver*> observers,
                const std::filesystem::path& folder) {
  Progress progress;
  if (!command.quiet) observers.push_back(&progress);
  const InterruptGuard guard;
  RunOptions options;
  options.threads = command.threads;
  options.executor = command.serial ? Executor::serial : Executor::flow;
  options.folder = folder;
  options.keep_going = command.keep_going;
  options.cancel = &interrupted;
  options.observers = std::move(observers);
  try {
    Outcome outcome{success, run(graph, options)};
    for (const auto& failure : outcome.result->failures) fmt::print(stderr, "failed: {}\n", failure.str());
    if (!outcome.result->failures.empty()) outcome.code = failed;
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
    fmt::print(stderr, "{}", diagnostics.str());
    return usage;
  }
  RunFolder folder(*graph, command.folder);
  const Outcome outcome = execute(*graph, command, {&folder}, folder.path());
  fmt::print("run folder: {}\n", folder.path().string());
  if (outcome.result) name_artifacts(*outcome.result, folder.path());
  return outcome.code;
}

}  // namespace talkgraph::cli
