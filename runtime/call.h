#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "runtime/executor.h"
#include "runtime/keeper.h"

namespace talkgraph {

/// A whole stream as its readers get it.
struct Gathered {
  std::uint64_t items = 0;  ///< of the domain, with nothings
  std::shared_ptr<const std::vector<Item<Value>>> values = std::make_shared<std::vector<Item<Value>>>();
};

/// What both executors share: one call of one node. It puts the inputs
/// together, gives Context and Random, keeps the books and the times, and puts
/// node, item and place to errors.
class Caller {
 public:
  /// `keeper` is null where nothing is kept.
  Caller(const Graph& graph, const RunOptions& options, Keeper* keeper);

  /// The inputs that are the same in every call of a node.
  std::vector<Input> fixed_inputs(int node, const std::function<Value(Graph::Port)>& single,
                                  const std::function<Gathered(Graph::Port)>& gathered);
  /// Adds those of one item.
  void add_item_inputs(int node, std::vector<Input>& inputs, const std::function<const Value&(Graph::Port)>& item);

  /// One value an output port; empty ones if nobody wants them, if a required input has nothing, if
  /// the node drops the item, or if it failed and the run keeps going. Throws
  /// RunError, Cancelled or Cache::Damaged.
  std::vector<Value> call(int node, const std::string& item, std::vector<Input> inputs);

  /// Makes running nodes give up; later calls throw Cancelled.
  void stop() { stop_ = true; }
  bool stopped() const { return stop_ || (options_.cancel && *options_.cancel); }

  void domain_size(int source, std::size_t items) const;
  std::vector<NodeStats> stats() const;
  std::vector<Failure> failures() const;

 private:
  friend class OpenSource;

  struct Count {
    std::atomic<std::uint64_t> items{0}, values{0};
    void add(std::uint64_t i, std::uint64_t v) { items += i, values += v; }
  };
  struct Books {
    std::deque<Count> in, out;
    std::atomic<std::uint64_t> calls{0}, skipped{0}, failed{0}, loaded{0}, unneeded{0};
    std::atomic<std::int64_t> wall{0}, cpu{0}, saved{0};  // nanoseconds
  };
  class Watch;
  struct Desk;

  const Graph::Node& node(int n) const { return graph_.nodes[static_cast<std::size_t>(n)]; }
  Books& books(int n) { return books_[static_cast<std::size_t>(n)]; }
  Context context(int node, const std::string& item) const;
  bool complete(int node, const std::vector<Input>& inputs) const;
  void sent(int node, const std::vector<Value>& outputs);
  std::vector<Value> load(int node, const std::string& item);
  std::vector<Value> compute(int node, const std::string& item, const std::vector<Input>& inputs);
  void keep(int node, const std::string& item, const Cache::Result& result, const std::filesystem::path& written);
  /// Whether a failed item may have had a hand in what a node makes of an item.
  bool tainted(int node, const std::string& item) const;
  /// Books a failure; throws RunError unless the run keeps going.
  void failed(int node, const std::string& item, std::string cause);
  void check_stopped() const {
    if (stopped()) throw Cancelled();
  }

  const Graph& graph_;
  const RunOptions& options_;
  Keeper* const keeper_;
  std::deque<Books> books_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Failure> failures_;
  std::vector<std::pair<int, std::string>> failed_;  // nodes and items of failures_
};

/// A source at work: its stream with what the stream refers to.
class OpenSource {
 public:
  /// Opens the stream; it is empty if a required input has nothing.
  OpenSource(Caller& caller, int node, std::vector<Input> inputs);
  /// The next item. Throws as Caller::call does, also on a key that came before.
  std::optional<Item<std::vector<Value>>> next();

 private:
  std::optional<Item<std::vector<Value>>> pull();

  Caller& caller_;
  const int node_;
  Context context_;
  Random random_;
  std::optional<AnyStream> stream_;
  std::set<std::string> keys_;
  std::string last_;
  std::size_t pulled_ = 0;
};

}  // namespace talkgraph
