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

ProgressStyle usual_style(std::FILE* out) {
  return isatty(fileno(out)) != 0 ? ProgressStyle::terminal : ProgressStyle::plain;
}

Progress::Progress(ProgressStyle style, std::FILE* out)
    : Progress(style, out,
               style == ProgressStyle::quiet      ? Clock::duration::max()
               : style == ProgressStyle::terminal ? std::chrono::milliseconds(200)
               : style == ProgressStyle::json     ? std::chrono::milliseconds(1000)
                                                  : std::chrono::milliseconds(5000)) {}

Progress::Progress(ProgressStyle style, std::FILE* out, Clock::duration interval)
    : style_(style), out_(out), interval_(interval) {}

Progress::~Progress() { stop(); }

void Progress::started(const Graph& graph) {
  stop();
  if (style_ == ProgressStyle::json) tell("", {{"event", "started"}, {"graph", graph.name}});
  const std::lock_guard lock(mutex_);
  graph_ = &graph;
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
  tell(fmt::format("warning: {}{}: {}", name(node), item.empty() ? "" : fmt::format(", item \"{}\"", item), message),
       {{"event", "warning"}, {"node", name(node)}, {"item", item}, {"message", message}});
}

void Progress::notice(std::string_view message) {
  tell(fmt::format("warning: {}", message), {{"event", "warning"}, {"message", message}});
}

void Progress::failed(const Failure& failure) {
  Json event = {{"event", "failure"}};
  event.update(to_json(failure));
  tell(failure.str(), event);
}

void Progress::tell(const std::string& text, const Json& event) {
  const std::lock_guard lock(mutex_);
  erase();
  fmt::print(out_, "{}\n", style_ == ProgressStyle::json ? event.dump() : text);
  std::fflush(out_);
}

void Progress::ended(const RunReport& report) {
  stop();
  if (style_ == ProgressStyle::json) {
    Json event = {{"event", "ended"}};
    event.update(to_json(*graph_, report));
    return tell("", event);
  }
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
    if (!state.working.empty()) all.push_back(text(pace(state, now)));
  return all;
}

Progress::Pace Progress::pace(const NodeState& state, Clock::time_point now) const {
  Pace out;
  out.node = state.name;
  out.runs_once = state.runs_once;
  out.seconds = seconds(now - state.since);
  // Items for which a node has nothing to do are no measure of its pace.
  out.done = state.source ? state.done : std::min(state.calls, state.done);
  double done = static_cast<double>(out.done);
  for (const auto& [item, share] : state.working) done += share;
  out.share = done;
  const auto total = totals_.find(state.domain);
  if (state.runs_once)
    out.total = 1;
  else if (total != totals_.end())
    out.total = static_cast<double>(total->second - (state.done - out.done));
  if (!state.runs_once && out.done > 0 && out.seconds > 0) out.rate = static_cast<double>(out.done) / out.seconds;
  if (out.total > 0 && done > 0 && done <= out.total && out.seconds > 0)
    out.left = out.seconds * (out.total - done) / done;
  return out;
}

std::string Progress::text(const Pace& pace) {
  std::string out = fmt::format("{:<28} ", pace.node);
  if (pace.runs_once)
    out += pace.share > 0 ? fmt::format("{:3.0f} %", 100 * pace.share) : "working";
  else
    out += pace.total > 0 ? fmt::format("{}/{:.0f}", pace.done, pace.total) : fmt::format("{}", pace.done);
  out += "  " + duration_text(pace.seconds);
  if (pace.rate) out += fmt::format("  {:.3g}/s", *pace.rate);
  if (pace.left) out += fmt::format("  {} left", duration_text(*pace.left));
  return out;
}

Json Progress::json(const Pace& pace) {
  Json out = {{"event", "progress"}, {"node", pace.node}};
  if (pace.runs_once)
    out["share"] = pace.share;
  else
    out["done"] = pace.done;
  if (!pace.runs_once && pace.total > 0) out["total"] = pace.total;
  out["seconds"] = pace.seconds;
  if (pace.rate) out["rate"] = *pace.rate;
  if (pace.left) out["left"] = *pace.left;
  return out;
}

// Called with the mutex held.
void Progress::report() {
  erase();
  const auto now = Clock::now();
  std::vector<Pace> busy;
  for (auto& state : nodes_) {
    // A fast node is seldom caught in a call: what went on since the last report counts as busy.
    const bool at_work = !state.working.empty() || state.changed;
    state.changed = false;
    if (at_work && state.begun) busy.push_back(pace(state, now));
  }
  std::stable_sort(busy.begin(), busy.end(),
                   [](const Pace& a, const Pace& b) { return a.left.value_or(INFINITY) > b.left.value_or(INFINITY); });
  if (style_ == ProgressStyle::json) {
    for (const auto& pace : busy) fmt::print(out_, "{}\n", json(pace).dump());
  } else {
    const bool terminal = style_ == ProgressStyle::terminal;
    busy.resize(std::min(busy.size(), terminal ? most_lines : most_plain_lines));
    for (const auto& pace : busy) {
      std::string line = text(pace);
      if (terminal && line.size() >= terminal_width(out_)) line.resize(terminal_width(out_) - 1);
      drawn_ += terminal;
      fmt::print(out_, "{}\n", line);
    }
  }
  std::fflush(out_);
}

void Progress::erase() {
  for (; drawn_ > 0; --drawn_) fmt::print(out_, "\x1b[1A\x1b[2K");
  std::fflush(out_);
}

}  // namespace talkgraph
