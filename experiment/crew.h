#pragma once

#include <atomic>
#include <functional>

#include "experiment/results.h"

namespace talkgraph {

struct CrewOptions {
  int threads = 2;               ///< of all trials together
  std::uint64_t memory = 0;      ///< that the process should not exceed, bytes; 0: 80 % of what the machine has free
  bool keep_going = false;       ///< a trial goes on when an item fails
  Cache* cache = nullptr;        ///< shared by all; none: all is computed
  std::filesystem::path folder;  ///< trials write to <folder>/trials/<name>
  const std::atomic<bool>* cancel = nullptr;
  /// Told, one at a time, as a trial starts (status "not run") and when it has ended. If it throws, that is a warning.
  std::function<void(std::size_t trial, const TrialResult& result)> on_change;
  /// Told of what a trial warns of.
  std::function<void(std::size_t trial, std::string_view message)> on_warning;
};

/// Runs all trials, several at a time as threads and memory allow. The first runs alone: what the trials have in common
/// is then found by the others, and how much memory a trial takes is known. A trial that fails does not stop the
/// others. `results` has one a trial and is filled as they end.
void run_trials(const Experiment& experiment, const std::vector<Graph>& graphs, const CrewOptions& options,
                std::vector<TrialResult>& results);

}  // namespace talkgraph
