#include "cli/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "cli/cache.h"
#include "cli/signals.h"
#include "experiment/crew.h"
#include "experiment/page.h"
#include "experiment/series.h"
#include "graph/output_file.h"
#include "runtime/forecast.h"
#include "runtime/progress.h"

namespace talkgraph::cli {
namespace {

using Clock = std::chrono::steady_clock;
using Status = TrialResult::Status;

/// What a trial would take from the cache, and what it would compute.
void list_trials(const Experiment& experiment, const std::vector<Graph>& graphs, const Cache& cache,
                 const std::atomic<bool>* cancel) {
  fmt::print("{:>7} {:>7}  {}\n", "kept", "to do", "run");
  for (std::size_t t = 0; t < graphs.size(); ++t) {
    const Forecast forecast(graphs[t], cache, cancel);
    std::size_t kept = 0, missing = 0;
    bool foreseen = true;
    std::string fails;
    for (std::size_t n = 0; n < graphs[t].nodes.size(); ++n) {
      const auto& type = *graphs[t].nodes[n].type;
      if (type.makes_stream && forecast.fails(static_cast<int>(n)))
        fails = fmt::format(": will fail, as node \"{}\" does", graphs[t].nodes[n].name);
      if (!type.stored && !type.sink) continue;
      const auto counts = forecast.counts(static_cast<int>(n));
      kept += counts.load, missing += counts.call;
      foreseen = foreseen && (counts.foreseen || counts.call == 0);
    }
    fmt::print("{:>7} {:>6}{}  {}{}\n", kept, missing, foreseen ? " " : "+", experiment.trials[t].name, fails);
  }
  fmt::print("{} runs; kept: results that are found; to do: results that are made and kept (+: at least)\n",
             graphs.size());
}

/// Says how the trials go, and has the results written now and then.
class Journal {
 public:
  Journal(const Experiment& experiment, ProgressStyle style, std::function<void()> write)
      : experiment_(experiment), style_(style), write_(std::move(write)) {}

  void changed(std::size_t trial, const TrialResult& result) {
    const bool starts = result.status == Status::waiting;
    ended_ += !starts;
    if (style_ == ProgressStyle::json)
      tell_program(trial, result);
    else if (starts)
      tell(fmt::format("{}: started", name(trial)));
    else if (result.status == Status::failed)
      fmt::print(stderr, "{}: failed: {}\n", name(trial), result.error);
    else if (result.status == Status::finished)
      tell(fmt::format("[{}/{}] {}: done in {}, {} calls, {} found{}", ended_, experiment_.trials.size(), name(trial),
                       duration_text(result.wall), result.calls, result.loaded, left()));
    // Not after each of a thousand short trials.
    if (starts || Clock::now() - written_ < std::chrono::seconds(2)) return;
    write_();
    written_ = Clock::now();
  }

  void warned(std::size_t trial, std::string_view message) const {
    if (style_ == ProgressStyle::json)
      print({{"event", "warning"}, {"run", name(trial)}, {"message", message}});
    else
      fmt::print(stderr, "{}: warning: {}\n", name(trial), message);
  }

  void warn(std::string_view message) const {
    if (style_ == ProgressStyle::json)
      print({{"event", "warning"}, {"message", message}});
    else
      fmt::print(stderr, "warning: {}\n", message);
  }

 private:
  const std::string& name(std::size_t trial) const { return experiment_.trials[trial].name; }
  static void print(const Json& event) { fmt::print(stderr, "{}\n", event.dump()); }

  void tell(const std::string& text) const {
    if (style_ != ProgressStyle::quiet) fmt::print(stderr, "{}\n", text);
  }

  void tell_program(std::size_t trial, const TrialResult& result) const {
    if (result.status == Status::waiting) return print({{"event", "run started"}, {"run", name(trial)}});
    print({{"event", "run ended"},
           {"run", name(trial)},
           {"status", status_text(result.status)},
           {"error", result.error},
           {"seconds", result.wall},
           {"calls", result.calls},
           {"found", result.loaded},
           {"done", ended_},
           {"total", experiment_.trials.size()}});
  }

  std::string left() const {
    const std::size_t waiting = experiment_.trials.size() - ended_;
    const double elapsed = std::chrono::duration<double>(Clock::now() - begun_).count();
    if (waiting == 0) return "";
    return fmt::format("; about {} left",
                       duration_text(elapsed / static_cast<double>(ended_) * static_cast<double>(waiting)));
  }

  const Experiment& experiment_;
  const ProgressStyle style_;
  const std::function<void()> write_;
  const Clock::time_point begun_ = Clock::now();
  Clock::time_point written_ = begun_;
  std::size_t ended_ = 0;
};

ExitCode tell_end(const std::vector<TrialResult>& results) {
  const auto count = [&](Status status) {
    return std::count_if(results.begin(), results.end(), [&](const auto& r) { return r.status == status; });
  };
  if (count(Status::stopped) > 0 || count(Status::waiting) > 0) {
    fmt::print(stderr, "stopped after {} of {} runs; the same command goes on\n", count(Status::finished),
               results.size());
    return cancelled;
  }
  if (const auto n = count(Status::failed)) {
    fmt::print(stderr, "{} of {} runs failed, as said above\n", n, results.size());
    return failed;
  }
  return success;
}

std::filesystem::path folder_of(const ExperimentCommand& command, const std::string& name) {
  return command.run.folder.empty() ? std::filesystem::path("runs") / name : command.run.folder;
}

/// Runs the trials of one experiment and writes its folder, whenever something has changed also `changed`.
void run_trials_of(const Experiment& experiment, const std::vector<Graph>& graphs, const ExperimentCommand& command,
                   const std::filesystem::path& folder, Cache* cache, const std::atomic<bool>* cancel,
                   std::vector<TrialResult>& results, const std::function<void()>& changed) {
  const auto write = [&] {
    write_results(experiment, graphs, results, folder);
    changed();
  };
  Journal journal(experiment, command.run.progress.value_or(usual_style()), write);
  CrewOptions options;
  options.threads = command.run.threads;
  options.memory = command.memory;
  options.keep_going = command.run.keep_going;
  options.cache = cache;
  options.folder = folder;
  options.cancel = cancel;
  options.on_change = [&](std::size_t trial, const TrialResult& result) { journal.changed(trial, result); };
  options.on_warning = [&](std::size_t trial, std::string_view message) { journal.warned(trial, message); };
  run_trials(experiment, graphs, options, results);
  write();
  for (const auto& missing : missing_measures(experiment, estimate(experiment, results))) journal.warn(missing);
}

int run_single(const std::string& file, const ExperimentCommand& command, const Registry& registry) {
  Diagnostics diagnostics;
  auto experiment = load_experiment(file, diagnostics);
  if (experiment) set_in_all_runs(*experiment, command.run.sets, diagnostics);
  const auto graphs =
      experiment ? load_trials(*experiment, registry, diagnostics) : std::optional<std::vector<Graph>>();
  if (!graphs) return fmt::print(stderr, "{}\n", diagnostics.str()), usage;
  const InterruptGuard guard;
  const auto cache = open_cache(command.run);
  if (command.dry_run) return list_trials(*experiment, *graphs, *cache, guard.flag()), success;
  const auto folder = folder_of(command, experiment->name);
  claim_folder(folder, file, command.run.overwrite);
  std::vector<TrialResult> results;
  run_trials_of(*experiment, *graphs, command, folder, cache.get(), guard.flag(), results, [] {});
  fmt::print("{}\n", (folder / "experiment.html").string());
  return tell_end(results);
}

int run_series(const std::string& file, const ExperimentCommand& command, const Registry& registry) {
  Diagnostics diagnostics;
  auto series = load_series(file, registry, command.run.sets, diagnostics);
  if (!series) return fmt::print(stderr, "{}\n", diagnostics.str()), usage;
  const InterruptGuard guard;
  const auto cache = open_cache(command.run);
  const auto folder = folder_of(command, series->name);
  if (!command.dry_run) claim_folder(folder, file, command.run.overwrite);
  const auto write = [&] { write_file(folder / "report.html", series_page(*series)); };
  std::vector<TrialResult> all;
  for (auto& section : series->sections)
    for (auto& [experiment, graphs, results] : section.parts) {
      fmt::print(command.dry_run ? stdout : stderr, "{}\n", experiment.name);
      if (command.dry_run)
        list_trials(experiment, graphs, *cache, guard.flag());
      else if (!*guard.flag())
        run_trials_of(experiment, graphs, command, folder / experiment.name, cache.get(), guard.flag(), results, write);
      results.resize(experiment.trials.size());
      all.insert(all.end(), results.begin(), results.end());
    }
  if (command.dry_run) return success;
  write();
  fmt::print("{}\n", (folder / "report.html").string());
  return tell_end(all);
}

}  // namespace

int run_experiment(const std::string& file, const ExperimentCommand& command, const Registry& registry) {
  if (command.dry_run && !command.run.cached)
    throw std::invalid_argument("--dry-run looks into the cache: not with --no-cache");
  return is_series(file) ? run_series(file, command, registry) : run_single(file, command, registry);
}

}  // namespace talkgraph::cli
