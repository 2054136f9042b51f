#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/graph.h"
#include "runtime/executor.h"
#include "runtime/progress.h"

namespace talkgraph::cli {

/// What ends a command; documented in docs/cli.md.
enum ExitCode { success = 0, failed = 1, usage = 2, cancelled = 130 };

struct RunCommand {
  std::vector<std::string> sets;
  std::filesystem::path folder;  ///< empty: runs/<graph>-<time>
  int threads = 2;
  bool serial = false;
  bool keep_going = false;
  bool overwrite = false;                 ///< a folder that holds a run may be written to
  std::optional<ProgressStyle> progress;  ///< none: usual_style()
  bool cached = false;                    ///< results are kept and found
  std::filesystem::path trace;            ///< file for the trace viewers; empty: none
  std::filesystem::path cache;            ///< empty: Cache::default_folder()
  std::uint64_t cache_limit = Cache::default_limit;
};

/// Where the command's results are kept; null if it shall keep none.
std::unique_ptr<Cache> open_cache(const RunCommand& command);

/// `talkgraph run`: loads, checks and runs a graph in a run folder. The folder
/// and what the graph's sinks wrote are named on stdout, all else on stderr.
int run_file(const std::string& file, const RunCommand& command, const Registry& registry);

/// Runs a checked graph with progress on stderr; Ctrl-C stops it. The result is
/// empty if the run failed or was cancelled, which has been said by then.
struct Outcome {
  ExitCode code = success;
  std::optional<RunResult> result;
};
Outcome run_graph(const Graph& graph, const RunCommand& command);

}  // namespace talkgraph::cli
