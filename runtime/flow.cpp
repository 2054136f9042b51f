#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/spin_mutex.h>
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

/// An item on its way through a sweep, and when it is done, the next one. What
/// nodes make for it lies here, one slot a port, until the last reader of the sweep has run; only a pointer travels
/// along the edges. So joining is by item, an item without value travels like any other.
struct Flight {
  Flight(std::size_t slots, std::size_t runs) : values(slots), readers(slots), awaited(runs) {}

  const std::string* key = nullptr;       // null where there is no item
  std::size_t index = 0;                  // in its domain
  std::vector<Value> values;              // one a slot
  std::vector<std::atomic<int>> readers;  // of a slot, still to come
  std::vector<std::atomic<int>> awaited;  // of a run of nodes: the runs that it waits for
  std::atomic<int> left{0};               // runs still to come
  std::vector<Station*> stations;         // of the nodes, in the order of the runs
};

/// The items of a source, and what is held of them when a sweep is over: collecting in order is a walk over the items.
struct Domain {
  Keys keys;
  std::vector<std::vector<Value>> held;  // [slot][item]
};

using Pump = flow::multifunction_node<Flight*, std::tuple<Flight*, flow::continue_msg>>;
using Start = flow::continue_node<flow::continue_msg>;
using Join = flow::multifunction_node<Flight*, std::tuple<Flight*>, flow::queueing_lightweight>;
using Worker = flow::function_node<Flight*, Flight*>;

/// A node of a sweep: where its inputs come from and its outputs go.
struct Step {
  int node = 0;
  std::size_t station = 0;
  struct Take {
    std::size_t port = 0, slot = 0;
  };
  std::vector<Take> takes;
  std::vector<int> puts;  // the slot of each output, or -1
};

/// A sweep over the items of a domain: the start node hands `in_flight` flights
/// to the pump; each takes one item along and comes back when the last node
/// of the sweep has run for it.
struct Sweep {
  std::vector<std::vector<Step>> runs;
  std::vector<int> readers;  // of each slot: those of the sweep, and one if it is held
  struct Fetch {
    std::size_t slot = 0;
    bool last = false;  // no later sweep wants it
  };
  std::vector<Fetch> fetched;     // what earlier sweeps held
  std::vector<std::size_t> held;  // slots that are wanted when the sweep is over

  std::optional<OpenSource> source;  // of the sweep that opens its domain
  std::size_t next = 0;              // item, of a later sweep
  int out = 0;                       // flights that may still bring an item
  tbb::spin_mutex door;              // of what follows; never held for long
  std::atomic<bool> drawing{false};
  std::vector<Flight*> waiting;  // for the one that draws to leave
  std::deque<Flight> flights;
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
    int slot = -1;        // in the items of its domain, -1 if no node reads it there
    int last_sweep = -1;  // that reads it item by item
    Value single;         // of a node that runs once
    Gathered gathered;    // of a stream that is read whole
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

  void lay_out() {
    const std::size_t count = graph_.nodes.size();
    shelves_ = std::vector<std::vector<Shelf>>(count);
    domains_ = std::vector<Domain>(count);
    sweeps_ = std::vector<Sweep>(plan_.units.size());
    for (std::size_t n = 0; n < count; ++n) shelves_[n] = std::vector<Shelf>(graph_.nodes[n].type->outputs.size());
    for (std::size_t u = 0; u < plan_.units.size(); ++u) {
      for (const auto& p : outside_ports(plan_.units[u])) read_whole(p);
      if (plan_.units[u].domain >= 0) read_items(static_cast<int>(u));
    }
    for (const auto& output : graph_.outputs) read_whole(output.source);
    for (std::size_t u = 0; u < plan_.units.size(); ++u)
      if (plan_.units[u].domain >= 0) lay_out_sweep(static_cast<int>(u));
  }

  void give_slot(Graph::Port p) {
    auto& held = domains_[at(domain_of(p))].held;
    if (shelf(p).slot >= 0) return;
    shelf(p).slot = static_cast<int>(held.size());
    held.emplace_back();
  }
  void read_whole(Graph::Port p) {
    if (domain_of(p) >= 0 && !std::exchange(shelf(p).is_gathered, true)) give_slot(p);
    ++shelf(p).units;
  }
  void read_items(int u) {
    for (const int n : plan_.units[at(u)].nodes)
      for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way w) {
        if (w != Way::item) return;
        give_slot(source);
        shelf(source).last_sweep = u;
      });
  }

  void lay_out_sweep(int u) {
    const auto& unit = plan_.units[at(u)];
    auto& sweep = sweeps_[at(u)];
    sweep.readers.resize(domains_[at(unit.domain)].held.size());
    std::vector<Graph::Port> fetched;
    std::size_t station = 0;
    for (const auto& run : unit.runs) {
      auto& steps = sweep.runs.emplace_back();
      for (const int n : run.nodes) {
        auto& step = steps.emplace_back(Step{n, station++, {}, {}});
        for_each_source(graph_, n, [&](std::size_t input, Graph::Port source, Way w) {
          if (w != Way::item) return;
          step.takes.push_back({input, at(shelf(source).slot)});
          ++sweep.readers[at(shelf(source).slot)];
          if (plan_.unit[at(source.node)] != u) add_once(fetched, source);
        });
        for (const auto& s : shelves_[at(n)]) step.puts.push_back(s.slot);
      }
    }
    for (const auto& p : fetched) sweep.fetched.push_back({at(shelf(p).slot), shelf(p).last_sweep == u});
    for_each_node(unit, [&](int n) {
      for (const auto& s : shelves_[at(n)]) {
        if (!s.is_gathered && s.last_sweep <= u) continue;
        sweep.held.push_back(at(s.slot));
        ++sweep.readers[at(s.slot)];
      }
    });
  }

  // ---- the flow graph: nodes and edges ------------------------------------

  void build() {
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

  /// A worker for every run of nodes.
  void build_sweep(std::size_t u) {
    auto& pump = sweeps_[u].pump;
    pump = std::make_unique<Pump>(flow_, flow::serial, [this, u](Flight* flight, Pump::output_ports_type& ports) {
      pump_one(u, *flight, ports);
    });
    starts_.push_back(std::make_unique<Start>(flow_, [this, u](flow::continue_msg) { start_sweep(u); }));
    const std::size_t first = workers_.size();
    const auto& runs = plan_.units[u].runs;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      workers_.push_back(std::make_unique<Worker>(flow_, flow::unlimited, [this, u, r](Flight* flight) {
        work(u, r, *flight);
        return flight;
      }));
      auto& worker = *workers_.back();
      const auto& after = runs[r].after;
      if (after.empty()) {
        flow::make_edge(flow::output_port<0>(*pump), worker);
      } else if (after.size() == 1) {
        flow::make_edge(*workers_[first + at(after[0])], worker);
      } else {
        joins_.push_back(std::make_unique<Join>(flow_, flow::unlimited,
                                                [r](Flight* flight, Join::output_ports_type& ports) noexcept {
                                                  if (flight->awaited[r].fetch_sub(1) == 1)
                                                    std::get<0>(ports).try_put(flight);
                                                }));
        for (const int before : after) flow::make_edge(*workers_[first + at(before)], *joins_.back());
        flow::make_edge(flow::output_port<0>(*joins_.back()), worker);
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

  std::vector<Input> fixed_inputs(int n) {
    return caller_.fixed_inputs(
        n, [&](Graph::Port p) { return shelf(p).single; }, [&](Graph::Port p) { return shelf(p).gathered; });
  }

  void finish(std::size_t u) {
    for (auto& flight : sweeps_[u].flights)
      for (auto* station : flight.stations) station->inputs.clear();
    sweeps_[u].flights.clear();
    for (const auto& p : outside_ports(plan_.units[u]))
      if (--shelf(p).units == 0) {
        shelf(p).single = {};
        shelf(p).gathered = {};
      }
  }

  void run_once(std::size_t u) {
    guarded([&] {
      const int n = plan_.units[u].nodes[0];
      auto& station = caller_.station(n, fixed_inputs(n));
      auto& values = caller_.call(station, "");
      station.inputs.clear();
      for (std::size_t p = 0; p < values.size(); ++p)
        if (shelves_[at(n)][p].units > 0) shelves_[at(n)][p].single = std::move(values[p]);
      values.clear();
      finish(u);
    });
  }

  void start_sweep(std::size_t u) {
    guarded([&] {
      const auto& unit = plan_.units[u];
      auto& sweep = sweeps_[u];
      for (int i = 0; i < in_flight_; ++i) sweep.flights.emplace_back(sweep.readers.size(), unit.runs.size());
      std::vector<std::pair<int, std::vector<Input>>> nodes;
      for (const auto& run : unit.runs)
        for (const int n : run.nodes) nodes.emplace_back(n, fixed_inputs(n));
      // What one flight uses lies together: threads would else write to the same cache lines.
      for (auto& flight : sweep.flights)
        for (const auto& [n, fixed] : nodes) flight.stations.push_back(&caller_.station(n, fixed));
      if (unit.opens)
        sweep.source.emplace(caller_, unit.domain, fixed_inputs(unit.domain), domains_[at(unit.domain)].keys);
      sweep.out = in_flight_;
      for (auto& flight : sweep.flights) sweep.pump->try_put(&flight);
    });
  }

  /// A flight has come: let the next item in.
  void pump_one(std::size_t u, Flight& flight, Pump::output_ports_type& ports) {
    guarded([&] {
      auto& sweep = sweeps_[u];
      if (!enter(sweep, flight)) return;
      bool drawn = draw(u, flight);
      while (drawn && sweep.runs.empty()) drawn = draw(u, flight);
      const bool over = !drawn && --sweep.out == 0;
      leave(sweep);
      if (drawn) std::get<0>(ports).try_put(&flight);
      if (!over) return;
      gather(u);
      finish(u);
      std::get<1>(ports).try_put({});
    });
  }

  /// One thread at a time draws items. Another one looks again for about as long as a cheap item takes; then its flight
  /// is left to the one that draws, as the thread has better to do than to wait for a slow source.
  static bool enter(Sweep& sweep, Flight& flight) {
    for (int i = 0; i < 1000 && sweep.drawing.load(std::memory_order_relaxed); ++i) {
    }
    const tbb::spin_mutex::scoped_lock lock(sweep.door);
    if (!sweep.drawing.exchange(true)) return true;
    sweep.waiting.push_back(&flight);
    return false;
  }
  static void leave(Sweep& sweep) {
    std::vector<Flight*> waiting;
    {
      const tbb::spin_mutex::scoped_lock lock(sweep.door);
      sweep.drawing = false;
      waiting.swap(sweep.waiting);
    }
    for (auto* flight : waiting) sweep.pump->try_put(flight);
  }

  /// The item of the flight has passed; takes the next one along, if there is one.
  bool draw(std::size_t u, Flight& flight) {
    if (flight.key) hold(u, flight);
    return next_item(u, flight);
  }

  /// Keeps what is still wanted of an item that has passed.
  void hold(std::size_t u, Flight& flight) {
    auto& held = domains_[at(plan_.units[u].domain)].held;
    for (const auto slot : sweeps_[u].held) {
      if (held[slot].size() <= flight.index) held[slot].resize(flight.index + 1);
      held[slot][flight.index] = std::move(flight.values[slot]);
    }
    flight.key = nullptr;
  }

  bool next_item(std::size_t u, Flight& flight) {
    const auto& unit = plan_.units[u];
    auto& sweep = sweeps_[u];
    auto& domain = domains_[at(unit.domain)];
    if (!unit.opens) {
      if (sweep.next == domain.keys.size()) return false;
      flight.index = sweep.next++;
      for (const auto& [slot, last] : sweep.fetched) {
        auto& value = domain.held[slot][flight.index];
        flight.values[slot] = last ? std::move(value) : value;
      }
    } else {
      if (!sweep.source) return false;
      auto made = sweep.source->next();
      if (!made) {
        sweep.source.reset();
        caller_.domain_size(unit.domain, domain.keys.size());
        return false;
      }
      flight.index = domain.keys.size() - 1;
      for (std::size_t p = 0; p < made->size(); ++p)
        if (const int slot = shelves_[at(unit.domain)][p].slot; slot >= 0)
          flight.values[at(slot)] = std::move((*made)[p]);
    }
    flight.key = &domain.keys[flight.index];
    for (std::size_t s = 0; s < sweep.readers.size(); ++s)
      flight.readers[s].store(sweep.readers[s], std::memory_order_relaxed);
    for (std::size_t r = 0; r < unit.runs.size(); ++r)
      flight.awaited[r].store(static_cast<int>(unit.runs[r].after.size()), std::memory_order_relaxed);
    flight.left.store(static_cast<int>(unit.runs.size()), std::memory_order_relaxed);
    return true;
  }

  /// A line that is all of its sweep goes on with the next item at once: that saves two tasks an item.
  void work(std::size_t u, std::size_t r, Flight& flight) {
    guarded([&] {
      auto& sweep = sweeps_[u];
      bool drawn = true;
      while (drawn) {
        for (const auto& step : sweep.runs[r]) do_step(step, flight);
        if (sweep.runs.size() > 1) {
          if (--flight.left == 0) sweep.pump->try_put(&flight);
          return;
        }
        if (!enter(sweep, flight)) return;
        drawn = draw(u, flight);
        leave(sweep);
      }
      sweep.pump->try_put(&flight);
    });
  }

  void do_step(const Step& step, Flight& flight) {
    auto& station = *flight.stations[step.station];
    for (const auto& [port, slot] : step.takes) station.give(port, take(flight, slot));
    auto& values = caller_.call(station, *flight.key);
    for (std::size_t p = 0; p < values.size(); ++p)
      if (step.puts[p] >= 0) flight.values[at(step.puts[p])] = std::move(values[p]);
    values.clear();
  }

  /// The last reader takes the value itself, which costs less than a copy.
  static Value take(Flight& flight, std::size_t slot) {
    auto& readers = flight.readers[slot];
    if (readers.load(std::memory_order_acquire) == 1) return std::move(flight.values[slot]);
    Value value = flight.values[slot];
    if (readers.fetch_sub(1) == 1) flight.values[slot] = {};
    return value;
  }

  /// All items have passed: put together what is read whole.
  void gather(std::size_t u) {
    const auto& unit = plan_.units[u];
    auto& domain = domains_[at(unit.domain)];
    for_each_node(unit, [&](int n) {
      for (auto& shelf : shelves_[at(n)]) {
        if (!shelf.is_gathered) continue;
        const bool last = shelf.last_sweep <= static_cast<int>(u);
        auto& held = domain.held[at(shelf.slot)];
        auto all = std::make_shared<std::vector<Item<Value>>>();
        all->reserve(held.size());
        for (std::size_t i = 0; i < held.size(); ++i)
          if (held[i]) all->push_back({domain.keys[i], last ? std::move(held[i]) : held[i]});
        shelf.gathered = {domain.keys.size(), std::move(all)};
        if (last) held = {};
      }
    });
  }

  std::vector<RunResult::Output> outputs() {
    std::vector<RunResult::Output> all;
    for (const auto& output : graph_.outputs) {
      auto& from = shelf(output.source);
      RunResult::Output out{output.name, domain_of(output.source) >= 0, from.single, {}};
      if (out.stream) {
        if (--from.units == 0)
          out.items = std::move(*from.gathered.values);
        else
          out.items = *from.gathered.values;
      }
      all.push_back(std::move(out));
    }
    return all;
  }

  const Graph& graph_;
  Caller& caller_;
  const Plan plan_;
  const int in_flight_;

  std::vector<std::vector<Shelf>> shelves_;  // [node][port]
  std::vector<Domain> domains_;              // [source]
  std::atomic<bool> failed_{false};
  std::exception_ptr thrown_;

  flow::graph flow_;
  std::vector<Sweep> sweeps_;                   // [unit]
  std::vector<std::unique_ptr<Start>> starts_;  // [unit]
  std::vector<std::unique_ptr<Worker>> workers_;
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
