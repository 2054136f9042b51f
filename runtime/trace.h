#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/observer.h"

namespace talkgraph {

/// Records a run for the trace viewers of Perfetto and Chrome: each call with its node, item, thread and, if it was
/// looked for in the cache, whether it was there, and the number of items that wait before each node. Written when the
/// run ends, whichever way.
class Trace : public RunObserver {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  explicit Trace(std::filesystem::path file);

  void started(const Graph& graph) override;
  void call_started(int node, const std::string& item) override;
  void call_ended(int node, const std::string& item) override;
  void loaded(int node, const std::string& item) override;
  void missed(int node, const std::string& item) override;
  void item_done(int node, const std::string& item) override;
  void ended(const RunReport& report) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Call {
    double start = 0;
    const char* cache = nullptr;  // "hit" or "miss", if its result was looked for
  };

  double now() const { return std::chrono::duration<double, std::micro>(Clock::now() - start_).count(); }
  /// A small number for the calling thread.
  int thread();
  void count_waiting(int node);

  const std::filesystem::path file_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  const Graph* graph_ = nullptr;
  std::map<unsigned long, int> threads_;
  std::map<std::pair<int, std::string>, Call> open_;
  std::vector<std::size_t> done_;  // items of each node
  Json events_ = Json::array();
};

}  // namespace talkgraph
