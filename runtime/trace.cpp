#include "runtime/trace.h"

#include <fmt/format.h>
#include <pthread.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "graph/output_file.h"

namespace talkgraph {

Trace::Trace(std::filesystem::path file) : file_(std::move(file)) {
  const OutputFile probe(file_);
  errno = std::filesystem::is_directory(file_) ? EISDIR : 0;
  if (errno || !std::ofstream(probe.part()))
    throw std::runtime_error(fmt::format("the trace {} cannot be written: {}", file_.string(), std::strerror(errno)));
}

void Trace::started(const Graph& graph) {
  const std::lock_guard lock(mutex_);
  graph_ = &graph;
  done_.assign(graph.nodes.size(), 0);
}

int Trace::thread() { return threads_.emplace(pthread_self(), static_cast<int>(threads_.size()) + 1).first->second; }

void Trace::call_started(int node, const std::string& item) {
  const std::lock_guard lock(mutex_);
  open_[{node, item}] = {now()};
}

void Trace::loaded(int node, const std::string& item) {
  const std::lock_guard lock(mutex_);
  open_[{node, item}].cache = "hit";
}

void Trace::missed(int node, const std::string& item) {
  const std::lock_guard lock(mutex_);
  open_[{node, item}].cache = "miss";
}

void Trace::call_ended(int node, const std::string& item) {
  const std::lock_guard lock(mutex_);
  const auto call = open_.find({node, item});
  if (call == open_.end()) return;
  Json args = {{"item", item}};
  if (call->second.cache) args["cache"] = call->second.cache;
  events_.push_back({{"name", graph_->nodes[static_cast<std::size_t>(node)].name},
                     {"cat", graph_->nodes[static_cast<std::size_t>(node)].type->name},
                     {"ph", "X"},
                     {"pid", 1},
                     {"tid", thread()},
                     {"ts", call->second.start},
                     {"dur", now() - call->second.start},
                     {"args", std::move(args)}});
  open_.erase(call);
}

void Trace::item_done(int node, const std::string&) {
  const std::lock_guard lock(mutex_);
  ++done_[static_cast<std::size_t>(node)];
  count_waiting(node);
}

/// Items that the source has made and the node has not done.
void Trace::count_waiting(int node) {
  const auto& self = graph_->nodes[static_cast<std::size_t>(node)];
  if (self.domain < 0 || self.type->makes_stream) return;
  const auto made = done_[static_cast<std::size_t>(self.domain)], done = done_[static_cast<std::size_t>(node)];
  events_.push_back({{"name", "waiting: " + self.name},
                     {"ph", "C"},
                     {"pid", 1},
                     {"ts", now()},
                     {"args", {{"items", made - std::min(made, done)}}}});
}

void Trace::ended(const RunReport&) {
  const std::lock_guard lock(mutex_);
  Json out = {{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events_)}};
  for (const auto& [id, number] : threads_)
    out["traceEvents"].push_back({{"name", "thread_name"},
                                  {"ph", "M"},
                                  {"pid", 1},
                                  {"tid", number},
                                  {"args", {{"name", fmt::format("thread {}", number)}}}});
  write_file(file_, out.dump());
  events_ = Json::array();
}

}  // namespace talkgraph
