#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>

#include "runtime/observer.h"

namespace talkgraph {

/// The folder of one run. Holds
///   graph.resolved.json  the graph as it can be run again
///   log.txt              what nodes said and what failed, with UTC times
///   run.json             status (running, finished, finished with failures, failed, cancelled), started and ended,
///                        seconds, peak memory, calls and times of each node, failures, the files that the run wrote
///   .written             while it runs: the files that it writes
/// and what sinks write. Give it to the run as an observer.
class RunFolder final : public RunObserver {
 public:
  /// Makes the folder, `runs/<graph>-<UTC time>` unless a path is given (which
  /// may exist): what an earlier run wrote there is removed, all else stays.
  /// Throws std::runtime_error if it cannot be written.
  explicit RunFolder(const Graph& graph, std::filesystem::path path = {});

  const std::filesystem::path& path() const { return path_; }
  void log(std::string_view message);

  void started(const Graph&) override;
  void log(int node, const std::string& item, std::string_view message) override;
  void warn(int node, const std::string& item, std::string_view message) override;
  void writes(const std::string& file) override;
  void notice(std::string_view message) override;
  void failed(const Failure&) override;
  void ended(const RunReport&) override;

 private:
  using Clock = std::chrono::system_clock;
  Json header(const std::string& status) const;

  const Graph& graph_;
  Clock::time_point started_ = Clock::now();
  std::filesystem::path path_;  // names itself after started_
  std::mutex mutex_;
  std::ofstream log_, written_;
};

}  // namespace talkgraph
