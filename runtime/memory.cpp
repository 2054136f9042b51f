#include "runtime/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>

namespace talkgraph {
namespace {

/// A number that a file begins with, or nothing.
std::optional<std::uint64_t> number_in(const char* file) {
  std::uint64_t value = 0;
  if (std::ifstream(file) >> value) return value;
  return {};
}

}  // namespace

std::uint64_t held_memory() {
  std::uint64_t total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t free_memory() {
  std::uint64_t bytes = 0;
  std::ifstream info("/proc/meminfo");
  for (std::string name, rest; bytes == 0 && info >> name; std::getline(info, rest))
    if (name == "MemAvailable:" && info >> bytes) bytes *= 1024;
  const auto limit = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  if (limit && used) bytes = std::min(bytes, *limit > *used ? *limit - *used : 0);
  return bytes;
}

void MemoryWatch::started(const Graph& graph) {
  most_.clear();
  most_.resize(graph.nodes.size());
}

void MemoryWatch::call_ended(int node, const std::string&) {
  auto& most = most_[static_cast<std::size_t>(node)];
  const auto now = held();
  for (auto before = most.load(); before < now && !most.compare_exchange_weak(before, now);) {
  }
}

std::uint64_t MemoryWatch::held() {
  const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch().count();
  auto asked = asked_.load();
  if (now - asked > 1'000'000 && asked_.compare_exchange_strong(asked, now)) held_ = held_memory();
  return held_;
}

}  // namespace talkgraph
