#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "graph/files_read.h"
#include "graph/graph.h"
#include "graph/key.h"
#include "runtime/cache.h"
#include "runtime/plan.h"

namespace talkgraph {

/// What a call of a node for an item comes to.
enum class Need {
  call,  ///< it is called
  load,  ///< its result lies in the cache and is wanted
  skip,  ///< nobody wants it: what reads it lies in the cache
};

/// The keys of all that a run makes, and what of it need be made, known before anything is computed.
///
/// The key of a call is made of the node's recipe, its item and the keys of its inputs; the key of what a source makes,
/// of its content. Sources without inputs are opened to learn their items. A source that reads computed values (the
/// states of a trained model) cannot be: its whole stream has a key made of its recipe, and its items are entered when
/// the run has made them.
class Forecast {
 public:
  /// Opens sources; gives up with Cancelled when `cancel` is set.
  Forecast(const Graph& graph, const Cache& cache, const std::atomic<bool>* cancel = nullptr);

  Need need(int node, const std::string& item) const;
  /// Of the call; for a source, of its whole stream. None for an item that nobody foresaw.
  Key key(int node, const std::string& item) const;
  /// An item that a source has made. Throws std::runtime_error if it differs from what the forecast saw.
  void enter(int source, const std::string& item, const std::vector<Value>& outputs);

  /// How many calls of a node come to what. Items that only the run can know count as one.
  struct Counts {
    std::size_t call = 0, load = 0, skip = 0;
    bool foreseen = true;
  };
  Counts counts(int node) const;
  /// Of a node that runs once, one of the empty item; of others, one an item that is known.
  std::vector<std::pair<std::string, Need>> needs(int node) const;
  /// Of a source, where they are known ahead, with keys of what was made.
  std::vector<std::pair<std::string, Key>> items(int source) const;
  /// Whether a source failed while its items were listed, as it will in a run.
  bool fails(int source) const { return domain(source).failed; }
  const Json& recipe(int node) const { return recipes_[static_cast<std::size_t>(node)]; }

  /// A file on which the result of a call depends and that has changed since its key was made; empty if there is none.
  std::filesystem::path changed_file(int node, const std::string& item) const;

  /// {"recipe": ..., "item": ..., "inputs": {port: key}}: what key() is made of.
  Json about(int node, const std::string& item) const;

 private:
  /// Keys and needs of one item, one a node of its domain in the order of Domain::nodes.
  struct Row {
    std::string item;
    std::vector<Key> made;  ///< by the source, one a port
    std::vector<FileStamp> files;
    std::vector<Key> keys;
    std::vector<Need> needs;
    std::vector<bool> wanted;
  };
  struct Domain {
    std::vector<int> nodes;  ///< without the source
    bool known = false;      ///< its items were learnt ahead
    bool failed = false;     ///< some could not be made: the run shall say why
    Row whole;               ///< stands for all items where they are not known
    std::deque<Row> rows;    ///< addresses stay
    std::unordered_map<std::string, Row*> at;
    mutable std::shared_mutex mutex;
  };

  const Graph::Node& node(int n) const { return graph_.nodes[static_cast<std::size_t>(n)]; }
  Domain& domain(int source) { return domains_[source]; }
  const Domain& domain(int source) const { return domains_.at(source); }
  std::size_t rank(int n) const { return ranks_[static_cast<std::size_t>(n)]; }
  /// Calls f(row) for all rows of a domain, or the one that stands for them.
  template <class F>
  void for_each_row(Domain& d, F f) {
    if (!d.known)
      f(d.whole);
    else
      for (auto& row : d.rows) f(row);
  }

  void make_keys(int node, const std::atomic<bool>* cancel);
  void learn_items(int source, const std::atomic<bool>* cancel);
  void expect_items(int source);
  /// Whether a node depends on more than the item at hand.
  bool reads_all(int node) const;
  std::vector<Key> made_by(int source, const std::vector<Value>& values) const;
  static Row new_row(const Domain& d, std::string item, std::vector<Key> made);
  std::vector<std::pair<std::string, Key>> input_keys(int node, const Row* row) const;
  Key call_key(int node, const Row* row) const;
  Key port_key(Graph::Port port, const Row* row) const;
  Key gathered_key(Graph::Port port) const;

  Need need_of(int node, const Key& key, bool wanted) const;
  void decide(int node);
  void want_inputs(int node, Row* row);
  const Row* row(int node, const std::string& item) const;

  const Graph& graph_;
  const Cache& cache_;
  std::vector<Json> recipes_;
  std::vector<Key> recipe_keys_;
  std::vector<FileStamp> recipe_files_;
  std::vector<std::size_t> ranks_;
  std::vector<bool> reads_all_;
  std::vector<Key> keys_;     // of nodes that run once, of whole streams for sources
  std::vector<Need> needs_;   // likewise
  std::vector<bool> wanted_;  // of nodes that run once and sources; of others: by something outside their items
  std::map<int, Domain> domains_;
  mutable std::map<std::pair<int, int>, Key> gathered_;
};

}  // namespace talkgraph
