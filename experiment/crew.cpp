#include "experiment/crew.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "runtime/memory.h"
#include "runtime/run_folder.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

/// Tells on what a trial warns of.
class Warnings final : public RunObserver {
 public:
  Warnings(const Graph& graph, std::function<void(std::string_view)> tell) : graph_(graph), tell_(std::move(tell)) {}
  void warn(int node, const std::string& item, std::string_view message) override {
    tell_(fmt::format("{}{}: {}", graph_.nodes[static_cast<std::size_t>(node)].name,
                      item.empty() ? "" : fmt::format(", item \"{}\"", item), message));
  }
  void notice(std::string_view message) override { tell_(message); }
  void failed(const Failure& failure) override { tell_(failure.str()); }

 private:
  const Graph& graph_;
  const std::function<void(std::string_view)> tell_;
};

class Crew {
 public:
  Crew(const Experiment& experiment, const std::vector<Graph>& graphs, const CrewOptions& options,
       std::vector<TrialResult>& results)
      : experiment_(experiment),
        graphs_(graphs),
        options_(options),
        results_(results),
        budget_(options.memory ? options.memory : held_memory() + free_memory() / 5 * 4) {}

  void run() {
    const std::jthread watch([this](const std::stop_token& end) { watch_memory(end); });
    std::vector<std::jthread> hands;
    const auto count = std::min(static_cast<std::size_t>(options_.threads), graphs_.size());
    for (std::size_t i = 0; i < count; ++i) hands.emplace_back([this] { work(); });
  }

 private:
  bool stopped() const { return options_.cancel && *options_.cancel; }

  bool may_start() const {
    if (working_ == 0) return true;
    return ended_ > 0 && static_cast<std::uint64_t>(working_ + 1) * each_ <= budget_;
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return next_ == graphs_.size() || stopped() || may_start(); });
      if (next_ == graphs_.size() || stopped()) return;
      const std::size_t trial = next_++;
      ++working_;
      const int threads = share();
      tell(trial);
      lock.unlock();
      TrialResult result = run_trial(trial, threads);
      lock.lock();
      weigh();
      malloc_trim(0);
      --working_;
      ++ended_;
      results_[trial] = std::move(result);
      tell(trial);
      wake_.notify_all();
    }
  }

  /// Threads of a trial that starts now: all if it will be alone, else its share.
  int share() const {
    const auto waiting = static_cast<int>(graphs_.size() - next_);
    int beside = std::min(options_.threads, working_ + waiting);
    if (ended_ == 0) beside = 1;
    while (beside > working_ && static_cast<std::uint64_t>(beside) * each_ > budget_) --beside;
    return options_.threads / std::max(1, beside);
  }

  /// Trials go on where the listener fails, on a full disk for one; that is told once.
  void tell(std::size_t trial) {
    if (!options_.on_change) return;
    try {
      options_.on_change(trial, results_[trial]);
    } catch (const std::exception& e) {
      if (!std::exchange(warned_, true) && options_.on_warning) options_.on_warning(trial, e.what());
    }
  }

  TrialResult run_trial(std::size_t trial, int threads) {
    TrialResult out;
    const Graph& graph = graphs_[trial];
    try {
      const fs::path path = options_.folder / "trials" / experiment_.trials[trial].name;
      RunFolder folder(graph, path);
      Warnings warnings(graph, [&](std::string_view message) {
        const std::lock_guard lock(mutex_);
        if (options_.on_warning) options_.on_warning(trial, message);
      });
      RunOptions run_options;
      run_options.threads = threads;
      run_options.folder = path;
      run_options.keep_going = options_.keep_going;
      run_options.cancel = options_.cancel;
      run_options.cache = options_.cache;
      run_options.observers = {&folder, &warnings};
      take(talkgraph::run(graph, run_options), out);
    } catch (const Cancelled&) {
      out.status = TrialResult::Status::stopped;
    } catch (const std::exception& e) {
      out.status = TrialResult::Status::failed;
      out.error = e.what();
    }
    return out;
  }

  void take(const RunResult& result, TrialResult& out) const {
    out.status = result.failures.empty() ? TrialResult::Status::finished : TrialResult::Status::failed;
    out.failures = result.failures.size();
    if (out.failures) out.error = result.failures.front().str();
    out.wall = result.wall;
    for (const auto& node : result.nodes) out.calls += node.calls, out.loaded += node.loaded;
    out.observations = observe(experiment_, result);
    out.shown = pick_shown(experiment_, result);
  }

  /// Learns what a trial takes at most.
  void weigh() { each_ = std::max(each_, held_memory() / static_cast<std::uint64_t>(std::max(1, working_))); }

  void watch_memory(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    while (!end.stop_requested()) {
      weigh();
      pause_.wait_for(lock, end, std::chrono::milliseconds(100), [] { return false; });
    }
  }

  const Experiment& experiment_;
  const std::vector<Graph>& graphs_;
  const CrewOptions& options_;
  std::vector<TrialResult>& results_;
  const std::uint64_t budget_;

  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable_any pause_;
  std::size_t next_ = 0, ended_ = 0;
  int working_ = 0;
  bool warned_ = false;
  std::uint64_t each_ = 0;  // bytes
};

}  // namespace

void run_trials(const Experiment& experiment, const std::vector<Graph>& graphs, const CrewOptions& options,
                std::vector<TrialResult>& results) {
  results.assign(graphs.size(), {});
  Crew(experiment, graphs, options, results).run();
}

}  // namespace talkgraph
