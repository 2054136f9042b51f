#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runtime/observer.h"

namespace talkgraph {

/// Tells how far a run is: on a terminal a live line for each busy node,
/// elsewhere plain lines every few seconds. Each gives the node's name, the
/// items done and their total where known, the rate, and an estimate of the
/// time left; the slowest come first. Warnings and failures are told at once.
class Progress final : public RunObserver {
 public:
  using Clock = std::chrono::steady_clock;

  /// `quiet`: warnings and failures only.
  explicit Progress(bool quiet = false, std::FILE* out = stderr);
  Progress(std::FILE* out, bool terminal, Clock::duration interval);
  ~Progress() override;

  void started(const Graph&) override;
  void domain_size(int source, std::size_t items) override;
  void call_started(int node, const std::string& item) override;
  void call_ended(int node, const std::string& item) override;
  void item_done(int node, const std::string& item) override;
  void progress(int node, const std::string& item, double share) override;
  void warn(int node, const std::string& item, std::string_view message) override;
  void notice(std::string_view message) override;
  void failed(const Failure&) override;
  void ended(const RunReport&) override;

  /// One line for each node at work.
  std::vector<std::string> lines(Clock::time_point now) const;

 private:
  struct NodeState {
    std::string name;
    int domain = -1;  ///< whose items are counted
    bool source = false;
    bool runs_once = false;
    std::size_t done = 0;
    std::size_t calls = 0;
    std::map<std::string, double> working;  ///< items in a call, with the share done
    Clock::time_point since{};              ///< first call
    bool begun = false;
    bool changed = false;  ///< since the last report
  };

  struct Line {
    std::string text;
    double left = 0;  ///< seconds, infinite where not known
  };
  Line line(const NodeState&, Clock::time_point now) const;
  void report();
  void tell(const std::string& text);
  void erase();
  void stop();

  std::FILE* const out_;
  const bool terminal_;
  const Clock::duration interval_;
  mutable std::mutex mutex_;
  std::vector<NodeState> nodes_;
  std::map<int, std::size_t> totals_;
  std::size_t drawn_ = 0;  ///< live lines on the terminal
  std::condition_variable_any wake_;
  std::jthread ticker_;
};

/// "45 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace talkgraph
