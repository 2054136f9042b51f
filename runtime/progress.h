#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/observer.h"

namespace talkgraph {

enum class ProgressStyle {
  terminal,  ///< a live line for each busy node
  plain,     ///< lines every few seconds
  json,      ///< for programs: an object a line, as docs/cli.md lists them
  quiet,     ///< warnings and failures only
};
/// Live lines on a terminal, plain ones elsewhere.
ProgressStyle usual_style(std::FILE* out = stderr);

/// Tells how far a run is: for each busy node its name, the items done and
/// their total where known, the rate, and an estimate of the time left; the
/// slowest come first. Warnings and failures are told at once.
class Progress final : public RunObserver {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Progress(ProgressStyle style, std::FILE* out = stderr);
  Progress(ProgressStyle style, std::FILE* out, Clock::duration interval);
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

  /// How far a node is.
  struct Pace {
    std::string node;
    bool runs_once = false;
    std::size_t done = 0;        ///< items
    double share = 0;            ///< of the one call of a node that runs once
    double total = 0;            ///< items to come and done; 0: not known
    double seconds = 0;          ///< since its first call
    std::optional<double> rate;  ///< items a second
    std::optional<double> left;  ///< seconds
  };
  Pace pace(const NodeState&, Clock::time_point now) const;
  static std::string text(const Pace&);
  static Json json(const Pace&);
  void report();
  /// A line of text, or the event of a program.
  void tell(const std::string& text, const Json& event);
  const std::string& name(int node) const { return nodes_[static_cast<std::size_t>(node)].name; }
  void erase();
  void stop();

  const ProgressStyle style_;
  std::FILE* const out_;
  const Clock::duration interval_;
  mutable std::mutex mutex_;
  const Graph* graph_ = nullptr;
  std::vector<NodeState> nodes_;
  std::map<int, std::size_t> totals_;
  std::size_t drawn_ = 0;  ///< live lines on the terminal
  std::condition_variable_any wake_;
  std::jthread ticker_;
};

/// "45 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace talkgraph
