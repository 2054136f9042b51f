#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "runtime/executors.h"
#include "runtime/plan.h"

namespace talkgraph {
namespace {

namespace flow = tbb::flow;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <class T>
void add_once(std::vector<T>& list, const T& element) {
  if (std::find(list.begin(), list.end(), element) == list.end()) list.push_back(element);
}

/// An item of a source on its way. What nodes make for it lies here, one slot a
/// port, until the last reader has run; only a pointer travels along the edges.
/// So joining is by item, an item without value travels like any other, and
/// collecting in order is a walk over the items.
struct FlowItem {
  FlowItem(std::string k, const std::vector<int>& readers_of_slot, std::size_t nodes)
      : key(std::move(k)), values(readers_of_slot.size()), readers(readers_of_slot.size()), awaited(nodes) {
    for (std::size_t s = 0; s < readers.size(); ++s) readers[s] = readers_of_slot[s];
  }

  std::string key;
  std::vector<Value> values;              // one a slot
  std::vector<std::atomic<int>> readers;  // of a slot, still to come
  std::vector<std::atomic<int>> awaited;  // of a node: nodes of its sweep that it waits for
  std::atomic<int> left{0};               // nodes of the sweep still to run
};

/// The items of a source.
struct Domain {
  std::vector<int> readers;    // of each slot
  std::deque<FlowItem> items;  // grows at the end, addresses stay
  std::vector<int> awaited;    // initial counts of its nodes, by rank in the domain
};

struct Ticket {};

using Pump = flow::multifunction_node<Ticket, std::tuple<FlowItem*, flow::continue_msg>>;
using Start = flow::continue_node<flow::continue_msg>;
using Join = flow::multifunction_node<FlowItem*, std::tuple<FlowItem*>, flow::queueing_lightweight>;
using Worker = flow::function_node<FlowItem*, FlowItem*>;

/// A sweep over the items of a domain: the start node hands `in_flight` tickets
/// to the pump; each ticket lets one item in and comes back when the last node
/// of the sweep has run for it.
struct Sweep {
  std::optional<OpenSource> source;  // of the sweep that opens its domain
  std::size_t next = 0;              // item, of a later sweep
  int out = 0;                       // tickets not in the pump
  std::unique_ptr<Pump> pump;
};

class FlowRun {
 public:
  FlowRun(const Graph& graph, Caller& caller, int in_flight)
      : graph_(graph), caller_(caller), plan_(make_plan(graph)), in_flight_(in_flight) {
    lay_out();
    build();
  }

  std::vector<RunResult::Output> run() {
    for (std::size_t u = 0; u < plan_.units.size(); ++u)
      if (plan_.units[u].after.empty()) starts_[u]->try_put({});
    flow_.wait_for_all();
    if (thrown_) std::rethrow_exception(thrown_);
    return outputs();
  }

 private:
  /// Where the values of a port lie, and who still needs them.
  struct Shelf {
    int slot = -1;      // in the items of its domain, -1 if no node reads it there
    Value single;       // of a node that runs once
    Gathered gathered;  // of a stream that is read whole
    bool is_gathered = false;
    std::atomic<int> units{0};  // that read single or gathered, still to come
  };

  const Graph::Node& node(int n) const { return graph_.nodes[at(n)]; }
  int domain_of(Graph::Port p) const { return node(p.node).output_domain(p.node); }
  Shelf& shelf(Graph::Port p) { return shelves_[at(p.node)][at(p.port)]; }
  template <class F>
  void for_each_node(const Plan::Unit& unit, F f) {
    if (unit.opens) f(unit.domain);
    for (const int n : unit.nodes) f(n);
  }
  /// The ports that a unit reads whole, each once.
  std::vector<Graph::Port> outside_ports(const Plan::Unit& unit) {
    std::vector<Graph::Port> ports;
    for_each_node(unit, [&](int n) {
      for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way w) {
        if (w != Way::item) add_once(ports, source);
      });
    });
    return ports;
  }
  /// The ports of which a node reads the item's value, each once.
  std::vector<Graph::Port> item_ports(int n) const {
    std::vector<Graph::Port> ports;
    for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way w) {
      if (w == Way::item) add_once(ports, source);
    });
    return ports;
  }
  /// The nodes of its own sweep that a node waits for.
  std::vector<int> awaited_nodes(int n) const {
    std::vector<int> nodes;
    for (const auto& p : item_ports(n))
      if (!node(p.node).type->makes_stream && plan_.unit[at(p.node)] == plan_.unit[at(n)]) add_once(nodes, p.node);
    return nodes;
  }

  void lay_out() {
    const std::size_t count = graph_.nodes.size();
    shelves_ = std::vector<std::vector<Shelf>>(count);
    domains_ = std::vector<Domain>(count);
    fixed_.resize(count);
    item_ports_.resize(count);
    rank_.resize(count);
    for (std::size_t n = 0; n < count; ++n) shelves_[n] = std::vector<Shelf>(graph_.nodes[n].type->outputs.size());

    const auto read_slot = [&](Graph::Port p) {
      auto& readers = domains_[at(domain_of(p))].readers;
      if (shelf(p).slot < 0) {
        shelf(p).slot = static_cast<int>(readers.size());
        readers.push_back(0);
      }
      ++readers[at(shelf(p).slot)];
    };
    const auto read_whole = [&](Graph::Port p) {
      if (domain_of(p) >= 0 && !std::exchange(shelf(p).is_gathered, true)) read_slot(p);
      ++shelf(p).units;
    };
    for (const auto& unit : plan_.units) {
      for (const auto& p : outside_ports(unit)) read_whole(p);
      for (const int n : unit.nodes) {
        if (unit.domain < 0) continue;
        item_ports_[at(n)] = item_ports(n);
        for (const auto& p : item_ports_[at(n)]) read_slot(p);
        auto& awaited = domains_[at(unit.domain)].awaited;
        rank_[at(n)] = awaited.size();
        awaited.push_back(static_cast<int>(awaited_nodes(n).size()));
      }
    }
    for (const auto& output : graph_.outputs) read_whole(output.source);
  }

  // ---- the flow graph: nodes and edges ------------------------------------

  void build() {
    sweeps_ = std::vector<Sweep>(plan_.units.size());
    workers_.resize(graph_.nodes.size());
    for (std::size_t u = 0; u < plan_.units.size(); ++u) {
      const auto& unit = plan_.units[u];
      if (unit.domain < 0)
        starts_.push_back(std::make_unique<Start>(flow_, [this, u](flow::continue_msg) { run_once(u); }));
      else
        build_sweep(u);
      for (const int before : unit.after) {
        if (plan_.units[at(before)].domain < 0)
          flow::make_edge(*starts_[at(before)], *starts_[u]);
        else
          flow::make_edge(flow::output_port<1>(*sweeps_[at(before)].pump), *starts_[u]);
      }
    }
  }

  void build_sweep(std::size_t u) {
    auto& pump = sweeps_[u].pump;
    pump = std::make_unique<Pump>(flow_, flow::serial,
                                  [this, u](Ticket, Pump::output_ports_type& ports) { pump_one(u, ports); });
    starts_.push_back(std::make_unique<Start>(flow_, [this, u](flow::continue_msg) { start_sweep(u); }));
    for (const int n : plan_.units[u].nodes) {
      workers_[at(n)] = std::make_unique<Worker>(flow_, flow::unlimited, [this, u, n](FlowItem* item) {
        work(u, n, *item);
        return item;
      });
      const auto awaited = awaited_nodes(n);
      if (awaited.empty()) {
        flow::make_edge(flow::output_port<0>(*pump), *workers_[at(n)]);
      } else if (awaited.size() == 1) {
        flow::make_edge(*workers_[at(awaited[0])], *workers_[at(n)]);
      } else {
        joins_.push_back(std::make_unique<Join>(
            flow_, flow::unlimited, [rank = rank_[at(n)]](FlowItem* item, Join::output_ports_type& ports) noexcept {
              if (item->awaited[rank].fetch_sub(1) == 1) std::get<0>(ports).try_put(item);
            }));
        for (const int m : awaited) flow::make_edge(*workers_[at(m)], *joins_.back());
        flow::make_edge(flow::output_port<0>(*joins_.back()), *workers_[at(n)]);
      }
    }
  }

  // ---- what the nodes do ---------------------------------------------------

  /// The first exception stops the run.
  template <class F>
  void guarded(F f) noexcept {
    if (failed_) return;
    try {
      f();
    } catch (...) {
      if (!failed_.exchange(true)) thrown_ = std::current_exception();
      caller_.stop();
      flow_.cancel();
    }
  }

  void fix_inputs(int n) {
    fixed_[at(n)] = caller_.fixed_inputs(
        n, [&](Graph::Port p) { return shelf(p).single; }, [&](Graph::Port p) { return shelf(p).gathered; });
  }

  void finish(const Plan::Unit& unit) {
    for_each_node(unit, [&](int n) { fixed_[at(n)].clear(); });
    for (const auto& p : outside_ports(unit))
      if (--shelf(p).units == 0) {
        shelf(p).single = {};
        shelf(p).gathered = {};
      }
  }

  void run_once(std::size_t u) {
    guarded([&] {
      const int n = plan_.units[u].nodes[0];
      fix_inputs(n);
      auto values = caller_.call(n, "", std::move(fixed_[at(n)]));
      for (std::size_t p = 0; p < values.size(); ++p)
        if (shelves_[at(n)][p].units > 0) shelves_[at(n)][p].single = std::move(values[p]);
      finish(plan_.units[u]);
    });
  }

  void start_sweep(std::size_t u) {
    guarded([&] {
      const auto& unit = plan_.units[u];
      auto& sweep = sweeps_[u];
      for_each_node(unit, [&](int n) { fix_inputs(n); });
      if (unit.opens) sweep.source.emplace(caller_, unit.domain, std::move(fixed_[at(unit.domain)]));
      sweep.out = in_flight_;
      for (int i = 0; i < in_flight_; ++i) sweep.pump->try_put({});
    });
  }

  /// A ticket has come: let the next item in. The pump is a serial node.
  void pump_one(std::size_t u, Pump::output_ports_type& ports) {
    guarded([&] {
      auto& sweep = sweeps_[u];
      --sweep.out;
      if (FlowItem* item = next_item(u)) {
        ++sweep.out;
        if (plan_.units[u].nodes.empty())
          sweep.pump->try_put({});
        else
          std::get<0>(ports).try_put(item);
      } else if (sweep.out == 0) {
        gather(u);
        finish(plan_.units[u]);
        std::get<1>(ports).try_put({});
      }
    });
  }

  FlowItem* next_item(std::size_t u) {
    const auto& unit = plan_.units[u];
    auto& sweep = sweeps_[u];
    auto& domain = domains_[at(unit.domain)];
    FlowItem* item = nullptr;
    if (!unit.opens) {
      if (sweep.next < domain.items.size()) item = &domain.items[sweep.next++];
    } else if (sweep.source) {
      if (auto made = sweep.source->next()) {
        item = &domain.items.emplace_back(std::move(made->key), domain.readers, domain.awaited.size());
        for (std::size_t n = 0; n < domain.awaited.size(); ++n) item->awaited[n] = domain.awaited[n];
        put(unit.domain, *item, std::move(made->value));
      } else {
        sweep.source.reset();
        caller_.domain_size(unit.domain, domain.items.size());
      }
    }
    if (item) item->left = static_cast<int>(unit.nodes.size());
    return item;
  }

  void work(std::size_t u, int n, FlowItem& item) {
    guarded([&] {
      auto inputs = fixed_[at(n)];
      caller_.add_item_inputs(n, inputs, [&](Graph::Port p) -> const Value& { return item.values[at(shelf(p).slot)]; });
      put(n, item, caller_.call(n, item.key, std::move(inputs)));
      for (const auto& p : item_ports_[at(n)]) release(item, at(shelf(p).slot));
      if (--item.left == 0) sweeps_[u].pump->try_put({});
    });
  }

  void put(int n, FlowItem& item, std::vector<Value> values) {
    for (std::size_t p = 0; p < values.size(); ++p)
      if (const int slot = shelves_[at(n)][p].slot; slot >= 0) item.values[at(slot)] = std::move(values[p]);
  }

  static void release(FlowItem& item, std::size_t slot) {
    if (--item.readers[slot] == 0) item.values[slot] = {};
  }

  /// All items have passed: put together what is read whole.
  void gather(std::size_t u) {
    const auto& unit = plan_.units[u];
    auto& items = domains_[at(unit.domain)].items;
    for_each_node(unit, [&](int n) {
      for (auto& shelf : shelves_[at(n)]) {
        if (!shelf.is_gathered) continue;
        auto all = std::make_shared<std::vector<Item<Value>>>();
        for (auto& item : items) {
          if (const auto& value = item.values[at(shelf.slot)]) all->push_back({item.key, value});
          release(item, at(shelf.slot));
        }
        shelf.gathered = {items.size(), std::move(all)};
      }
    });
  }

  std::vector<RunResult::Output> outputs() {
    std::vector<RunResult::Output> all;
    for (const auto& output : graph_.outputs) {
      RunResult::Output out{output.name, domain_of(output.source) >= 0, shelf(output.source).single, {}};
      if (out.stream) out.items = *shelf(output.source).gathered.values;
      all.push_back(std::move(out));
    }
    return all;
  }

  const Graph& graph_;
  Caller& caller_;
  const Plan plan_;
  const int in_flight_;

  std::vector<std::vector<Shelf>> shelves_;           // [node][port]
  std::vector<Domain> domains_;                       // [source]
  std::vector<std::vector<Input>> fixed_;             // [node]
  std::vector<std::vector<Graph::Port>> item_ports_;  // [node]
  std::vector<std::size_t> rank_;                     // [node] among the nodes of its domain
  std::atomic<bool> failed_{false};
  std::exception_ptr thrown_;

  flow::graph flow_;
  std::vector<Sweep> sweeps_;                     // [unit]
  std::vector<std::unique_ptr<Start>> starts_;    // [unit]
  std::vector<std::unique_ptr<Worker>> workers_;  // [node]
  std::vector<std::unique_ptr<Join>> joins_;
};

}  // namespace

std::vector<RunResult::Output> run_flow(const Graph& graph, Caller& caller, int threads, int in_flight) {
  std::optional<tbb::global_control> more;
  if (threads > tbb::info::default_concurrency())
    more.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute([&] { return FlowRun(graph, caller, in_flight).run(); });
}

}  // namespace talkgraph
