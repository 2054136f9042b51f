#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/executor.h"
#include "runtime/keeper.h"
#include "runtime/keys.h"

namespace talkgraph {

/// A whole stream as its readers get it.
struct Gathered {
  std::uint64_t items = 0;  ///< of the domain, with nothings
  std::shared_ptr<std::vector<Item<Value>>> values = std::make_shared<std::vector<Item<Value>>>();
};

/// A node at work, one call at a time: what is needed for every call and dear to make anew. A node has as many stations
/// as it works on items at once, so that none of this is shared between threads.
struct Station {
  int node = 0;
  const Functor* functor = nullptr;
  std::vector<Input> inputs;            ///< those that are the same in every call, and while one runs, the item's
  std::vector<std::size_t> item_ports;  ///< inputs that change with the item
  std::vector<std::size_t> required;    ///< inputs without which the node is not called
  std::vector<Value> outputs;           ///< of the last call
  Context context;
  Random random;
  NodeStats books;

  /// Puts in what the item at hand has for an input.
  void give(std::size_t port, Value value) {
    count(books.in[port], value);
    inputs[port].value = std::move(value);
  }
  bool complete() const {
    return std::all_of(required.begin(), required.end(), [&](std::size_t p) { return bool(inputs[p].value); });
  }
  static void count(PortCount& port, const Value& value) {
    port.items += 1;
    port.values += value ? 1 : 0;
  }
};

/// What both executors share: one call of one node. It gives Context and
/// Random, keeps the books and the times, and puts node, item and place to errors.
class Caller {
 public:
  /// `keeper` is null where nothing is kept.
  Caller(const Graph& graph, const RunOptions& options, Keeper* keeper);

  /// The inputs that are the same in every call of a node; asked for once.
  std::vector<Input> fixed_inputs(int node, const std::function<Value(Graph::Port)>& single,
                                  const std::function<Gathered(Graph::Port)>& gathered);
  /// A new station, with those inputs; it stays as long as the caller.
  Station& station(int node, std::vector<Input> fixed_inputs);

  /// Gives one value an output port, in the station, for the executor to take; empty ones if nobody wants them, if a
  /// required input has nothing, if the node drops the item, or if it failed and the run keeps going. The item's inputs
  /// are given before and gone behind it. Throws RunError, Cancelled or Cache::Damaged.
  std::vector<Value>& call(Station& station, const std::string& item);

  /// Makes running nodes give up; later calls throw Cancelled.
  void stop() { stop_ = true; }
  bool stopped() const { return stop_ || (options_.cancel && *options_.cancel); }

  void domain_size(int source, std::size_t items) const;
  std::vector<NodeStats> stats() const;
  std::vector<Failure> failures() const;
  /// Files that sinks wrote, below the run folder.
  std::vector<std::string> files() const;

 private:
  friend class OpenSource;

  class Watch;
  class Desk;

  const Graph::Node& node(int n) const { return graph_.nodes[static_cast<std::size_t>(n)]; }
  static void sent(Station& station, const std::vector<Value>& outputs);
  void load_or_compute(Station& station, Keeper& keeper);
  void load(Station& station);
  void compute(Station& station);
  void call_and_keep(Station& station);
  /// Books a file, named below the run folder, as written by the call at hand. Throws std::runtime_error if another
  /// call wrote it.
  void claim(const Station& station, const std::filesystem::path& file);
  /// Puts what a sink wrote into the run folder.
  void deliver(const Station& station, const std::filesystem::path& desk);
  /// Whether a failed item may have had a hand in what a node makes of an item.
  bool tainted(int node, const std::string& item) const;
  /// Books a failure; throws RunError unless the run keeps going.
  void failed(Station& station, const std::string& item, std::string cause);
  void check_stopped() const {
    if (stopped()) throw Cancelled();
  }

  const Graph& graph_;
  const RunOptions& options_;
  Keeper* const keeper_;
  std::vector<NodeStats> books_;  // of what came before there were stations
  std::deque<Station> stations_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;  // of what follows, and of making stations
  std::vector<Failure> failures_;
  std::vector<std::pair<int, std::string>> failed_;       // nodes and items of failures_
  std::map<std::filesystem::path, std::string> written_;  // by which call
};

/// A source at work: its stream with what the stream refers to.
class OpenSource {
 public:
  /// Opens the stream; it is empty if a required input has nothing. Keys of the items made are added to `keys`.
  OpenSource(Caller& caller, int node, std::vector<Input> inputs, Keys& keys);
  /// The next item, one value an output port. Throws as Caller::call does, also on a key that came before.
  std::optional<std::vector<Value>> next();

 private:
  std::optional<Item<std::vector<Value>>> pull();

  Caller& caller_;
  Station& station_;
  Random random_;
  std::optional<AnyStream> stream_;
  Keys& keys_;
  std::size_t pulled_ = 0;
};

}  // namespace talkgraph
