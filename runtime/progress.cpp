#include "runtime/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace talkgraph {
namespace {

constexpr std::size_t most_live_lines = 10;

double seconds(Progress::Clock::duration d) { return std::chrono::duration<double>(d).count(); }

std::size_t terminal_width(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(std::ceil(std::max(0.0, seconds)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(std::FILE* out)
    : Progress(out, isatty(fileno(out)) != 0,
               isatty(fileno(out)) != 0 ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000)) {}

Progress::Progress(std::FILE* out, bool terminal, Clock::duration interval)
    : out_(out), terminal_(terminal), interval_(interval) {}

Progress::~Progress() { stop(); }

void Progress::started(const Graph& graph) {
  stop();
  const std::lock_guard lock(mutex_);
  nodes_.clear();
  totals_.clear();
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    NodeState state;
    state.name = graph.nodes[n].name;
    state.domain = graph.nodes[n].output_domain(static_cast<int>(n));
    state.runs_once = state.domain < 0;
    nodes_.push_back(std::move(state));
  }
  ticker_ = std::jthread([this](std::stop_token end) {
    std::unique_lock ticking(mutex_);
    while (!end.stop_requested()) {
      wake_.wait_for(ticking, end, interval_, [] { return false; });
      if (!end.stop_requested()) report();
    }
  });
}

void Progress::domain_size(int source, std::size_t items) {
  const std::lock_guard lock(mutex_);
  totals_[source] = items;
}

void Progress::call_started(int node, const std::string& item) {
  const std::lock_guard lock(mutex_);
  auto& state = nodes_[static_cast<std::size_t>(node)];
  if (!state.begun) state.since = Clock::now();
  state.begun = state.changed = true;
  state.working[item] = 0;
}

void Progress::call_ended(int node, const std::string& item) {
  const std::lock_guard lock(mutex_);
  nodes_[static_cast<std::size_t>(node)].working.erase(item);
}

void Progress::item_done(int node, const std::string&) {
  const std::lock_guard lock(mutex_);
  auto& state = nodes_[static_cast<std::size_t>(node)];
  ++state.done;
  state.changed = true;
}

void Progress::progress(int node, const std::string& item, double share) {
  const std::lock_guard lock(mutex_);
  auto& working = nodes_[static_cast<std::size_t>(node)].working;
  if (const auto it = working.find(item); it != working.end()) it->second = std::clamp(share, 0.0, 1.0);
}

void Progress::failed(const Failure& failure) {
  const std::lock_guard lock(mutex_);
  erase();
  fmt::print(out_, "{}\n", failure.str());
  std::fflush(out_);
}

void Progress::ended(const RunReport&) {
  stop();
  const std::lock_guard lock(mutex_);
  erase();
}

void Progress::stop() {
  ticker_.request_stop();
  if (ticker_.joinable()) ticker_.join();
}

std::vector<std::string> Progress::lines(Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all;
  for (const auto& state : nodes_)
    if (!state.working.empty()) all.push_back(line(state, now));
  return all;
}

std::string Progress::line(const NodeState& state, Clock::time_point now) const {
  const double elapsed = seconds(now - state.since);
  double done = static_cast<double>(state.done);
  for (const auto& [item, share] : state.working) done += share;
  std::string text = fmt::format("{:<28} ", state.name);
  const auto total_at = totals_.find(state.domain);
  const double total = state.runs_once ? 1 : total_at != totals_.end() ? static_cast<double>(total_at->second) : 0;
  if (state.runs_once)
    text += done > 0 ? fmt::format("{:3.0f} %", 100 * done) : "working";
  else
    text += total > 0 ? fmt::format("{}/{:.0f}", state.done, total) : fmt::format("{}", state.done);
  text += "  " + duration_text(elapsed);
  if (!state.runs_once && state.done > 0 && elapsed > 0)
    text += fmt::format("  {:.3g}/s", static_cast<double>(state.done) / elapsed);
  if (total > 0 && done > 0 && done <= total && elapsed > 0)
    text += fmt::format("  {} left", duration_text(elapsed * (total - done) / done));
  return text;
}

// Called with the mutex held.
void Progress::report() {
  erase();
  const auto now = Clock::now();
  for (auto& state : nodes_) {
    // A fast node is seldom caught in a call: what went on since the last report counts as busy.
    const bool busy = !state.working.empty() || state.changed;
    state.changed = false;
    if (!busy || !state.begun || (terminal_ && drawn_ == most_live_lines)) continue;
    auto text = line(state, now);
    if (terminal_) {
      const auto width = terminal_width(out_);
      if (text.size() >= width) text.resize(width - 1);
      ++drawn_;
    }
    fmt::print(out_, "{}\n", text);
  }
  std::fflush(out_);
}

void Progress::erase() {
  for (; drawn_ > 0; --drawn_) fmt::print(out_, "\x1b[1A\x1b[2K");
  std::fflush(out_);
}

}  // namespace talkgraph
