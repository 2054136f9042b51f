#include "runtime/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace talkgraph {
namespace {

constexpr std::size_t most_lines = 10, most_plain_lines = 4;

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

Progress::Progress(bool quiet, std::FILE* out)
    : Progress(out, !quiet && isatty(fileno(out)) != 0,
               quiet                      ? Clock::duration::max()
               : isatty(fileno(out)) != 0 ? std::chrono::milliseconds(200)
                                          : std::chrono::milliseconds(5000)) {}

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
    state.source = graph.nodes[n].type->makes_stream;
    state.runs_once = state.domain < 0;
    nodes_.push_back(std::move(state));
  }
  if (interval_ == Clock::duration::max()) return;
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
  auto& state = nodes_[static_cast<std::size_t>(node)];
  state.working.erase(item);
  ++state.calls;
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

void Progress::warn(int node, const std::string& item, std::string_view message) {
  tell(fmt::format("warning: {}{}: {}", nodes_[static_cast<std::size_t>(node)].name,
                   item.empty() ? "" : fmt::format(", item \"{}\"", item), message));
}

void Progress::notice(std::string_view message) { tell(fmt::format("warning: {}", message)); }

void Progress::failed(const Failure& failure) { tell(failure.str()); }

void Progress::tell(const std::string& text) {
  const std::lock_guard lock(mutex_);
  erase();
  fmt::print(out_, "{}\n", text);
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
    if (!state.working.empty()) all.push_back(line(state, now).text);
  return all;
}

Progress::Line Progress::line(const NodeState& state, Clock::time_point now) const {
  const double elapsed = seconds(now - state.since);
  // Items for which a node has nothing to do are no measure of its pace.
  const std::size_t called = state.source ? state.done : std::min(state.calls, state.done);
  double done = static_cast<double>(called);
  for (const auto& [item, share] : state.working) done += share;
  Line out{fmt::format("{:<28} ", state.name), std::numeric_limits<double>::infinity()};
  const auto total_at = totals_.find(state.domain);
  const double total = state.runs_once             ? 1
                       : total_at == totals_.end() ? 0
                                                   : static_cast<double>(total_at->second - (state.done - called));
  if (state.runs_once)
    out.text += done > 0 ? fmt::format("{:3.0f} %", 100 * done) : "working";
  else
    out.text += total > 0 ? fmt::format("{}/{:.0f}", called, total) : fmt::format("{}", called);
  out.text += "  " + duration_text(elapsed);
  if (!state.runs_once && called > 0 && elapsed > 0)
    out.text += fmt::format("  {:.3g}/s", static_cast<double>(called) / elapsed);
  if (total > 0 && done > 0 && done <= total && elapsed > 0) {
    out.left = elapsed * (total - done) / done;
    out.text += fmt::format("  {} left", duration_text(out.left));
  }
  return out;
}

// Called with the mutex held.
void Progress::report() {
  erase();
  const auto now = Clock::now();
  std::vector<Line> lines;
  for (auto& state : nodes_) {
    // A fast node is seldom caught in a call: what went on since the last report counts as busy.
    const bool busy = !state.working.empty() || state.changed;
    state.changed = false;
    if (busy && state.begun) lines.push_back(line(state, now));
  }
  std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.left > b.left; });
  lines.resize(std::min(lines.size(), terminal_ ? most_lines : most_plain_lines));
  for (auto& [text, left] : lines) {
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
