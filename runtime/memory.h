#pragma once

#include <atomic>
#include <cstdint>
#include <deque>

#include "runtime/observer.h"

namespace talkgraph {

/// Memory that this process holds now, bytes.
std::uint64_t held_memory();
/// The most that it has held so far, bytes.
std::uint64_t peak_memory();
/// What a process may still take on this machine, bytes: what is free, and no more than its control group has left.
std::uint64_t free_memory();

/// The most memory that the process held as calls of each node ended: what a node has to do with a high one can be seen
/// by comparing it with its neighbours.
class MemoryWatch final : public RunObserver {
 public:
  void started(const Graph& graph) override;
  void call_ended(int node, const std::string& item) override;
  std::uint64_t most(std::size_t node) const { return most_[node]; }

 private:
  /// Not older than a millisecond: many calls are shorter than asking.
  std::uint64_t held();

  std::deque<std::atomic<std::uint64_t>> most_;
  std::atomic<std::int64_t> asked_{0};  // steady clock, nanoseconds
  std::atomic<std::uint64_t> held_{0};
};

}  // namespace talkgraph
