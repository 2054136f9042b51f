#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "graph/graph.h"

namespace talkgraph {

/// An item that could not be computed.
struct Failure {
  std::string node;
  std::string item;   ///< key, empty for a node that runs once
  std::string place;  ///< file:line:column of the node, where known
  std::string cause;

  /// `file:line:column: node "x", item "k": cause`
  std::string str() const;
};

/// What passed a port: every item is counted, also one for which there is nothing.
struct PortCount {
  std::uint64_t items = 0;
  std::uint64_t values = 0;
  bool operator==(const PortCount&) const = default;
};

struct NodeStats {
  std::uint64_t calls = 0;    ///< of the functor; items made, for a source
  std::uint64_t skipped = 0;  ///< not called, because an input had nothing
  std::uint64_t failed = 0;
  std::uint64_t loaded = 0;    ///< from the cache
  std::uint64_t unneeded = 0;  ///< not called, because what reads it was loaded
  double saved = 0;            ///< seconds that loaded calls once took
  std::uint64_t kept = 0;      ///< bytes of results in the cache, loaded or put there
  double wall = 0;             ///< seconds in calls, added up over threads
  double cpu = 0;              ///< seconds of processor time
  std::vector<PortCount> in, out;
};

/// How a run ended, whichever way it did.
struct RunReport {
  enum class Status { finished, failed, cancelled };
  Status status = Status::finished;
  std::string error;             ///< what stopped a failed run
  double wall = 0;               ///< seconds
  std::vector<NodeStats> nodes;  ///< as in the graph
  std::vector<Failure> failures;
  std::vector<std::string> files = {};  ///< that nodes wrote, below the run folder
};

/// {"node", "item", "place", "cause"}
Json to_json(const Failure& failure);
/// {"status", "error", "seconds", "failures": [...], "nodes": [{"name", "type", "calls", ...}]}; no error if there is
/// none.
Json to_json(const Graph& graph, const RunReport& report);

/// Watches a run: progress, a log, a trace. Nodes are given by their index.
/// Called from several threads at once.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void started(const Graph&) {}
  /// The number of items that a source will make, or has made, is known.
  virtual void domain_size(int /*source*/, std::size_t /*items*/) {}
  /// Around each call; a source is called to open its stream and for each item, whose key is not known then.
  virtual void call_started(int /*node*/, const std::string& /*item*/) {}
  virtual void call_ended(int /*node*/, const std::string& /*item*/) {}
  /// The call at hand found its result in the cache; told before it ends.
  virtual void loaded(int /*node*/, const std::string& /*item*/) {}
  /// The call at hand looked for its result in the cache in vain; told before it is computed.
  virtual void missed(int /*node*/, const std::string& /*item*/) {}
  /// The node is done with an item: called, skipped or failed. For a source: an item made.
  virtual void item_done(int /*node*/, const std::string& /*item*/) {}
  /// What a node tells through its Context.
  virtual void progress(int /*node*/, const std::string& /*item*/, double /*share*/) {}
  virtual void log(int /*node*/, const std::string& /*item*/, std::string_view /*message*/) {}
  virtual void warn(int /*node*/, const std::string& /*item*/, std::string_view /*message*/) {}
  /// A node is about to put a file, named from there, in the run folder.
  virtual void writes(const std::string& /*file*/) {}
  /// Of the run as a whole.
  virtual void notice(std::string_view /*message*/) {}
  /// An item failed and the run keeps going; what stops a run is told by ended().
  virtual void failed(const Failure&) {}
  virtual void ended(const RunReport&) {}
};

}  // namespace talkgraph
