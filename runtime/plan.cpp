#include "runtime/plan.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace talkgraph {
namespace {

class Planner {
 public:
  explicit Planner(const Graph& graph) : graph_(graph), gathered_(graph.nodes.size(), false) {
    plan_.unit.assign(graph.nodes.size(), -1);
    for (int n = 0; n < size(); ++n)
      for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way w) {
        if (w == Way::gathered) gathered_[at(source.node)] = true;
      });
  }

  Plan plan() {
    for (;;) {
      for (int n = 0; n < size(); ++n)
        if (!done(n) && runs_once(n) && ready(n, {})) add({-1, false, {n}, {}});
      const auto sweep = best_sweep();
      if (!sweep) break;
      add(*sweep);
    }
    for (int n = 0; n < size(); ++n)
      if (!done(n)) throw std::logic_error("node \"" + node(n).name + "\" cannot be scheduled");
    return std::move(plan_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  int size() const { return static_cast<int>(graph_.nodes.size()); }
  const Graph::Node& node(int n) const { return graph_.nodes[at(n)]; }
  bool done(int n) const { return plan_.unit[at(n)] >= 0; }
  bool runs_once(int n) const { return !node(n).type->makes_stream && node(n).domain < 0; }

  /// All that the node reads is complete, or comes item by item from the nodes of its sweep.
  bool ready(int n, const std::vector<int>& sweep) const {
    bool all = true;
    for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way w) {
      all &= done(source.node) || (w == Way::item && std::find(sweep.begin(), sweep.end(), source.node) != sweep.end());
    });
    return all;
  }

  struct Candidate {
    Plan::Unit unit;
    std::size_t left = 0;  ///< nodes of the domain that need a further sweep
    bool useful = false;   ///< it completes something that is gathered
  };

  std::optional<Candidate> candidate(int source) const {
    Candidate c{{source, !done(source), {}, {}}, 0, false};
    if (c.unit.opens && !ready(source, {})) return {};
    std::vector<int> within{source};
    for (int n = 0; n < size(); ++n) {
      if (done(n) || node(n).type->makes_stream || node(n).domain != source) continue;
      if (ready(n, within))
        within.push_back(n);
      else
        ++c.left;
    }
    c.unit.nodes.assign(within.begin() + 1, within.end());
    if (c.unit.nodes.empty() && !c.unit.opens) return {};
    for (const int n : within) c.useful |= !done(n) && gathered_[at(n)];
    return c;
  }

  /// A sweep that finishes its domain if there is one, else one that lets
  /// others go on; then the one that leaves least waiting.
  std::optional<Plan::Unit> best_sweep() const {
    std::optional<Candidate> best;
    for (int n = 0; n < size(); ++n) {
      if (!node(n).type->makes_stream) continue;
      const auto c = candidate(n);
      if (c && (c->left == 0 || c->useful) && (!best || c->left < best->left)) best = c;
    }
    if (!best) return {};
    return best->unit;
  }

  void add(Plan::Unit unit) {
    const int index = static_cast<int>(plan_.units.size());
    const auto after = [&](int u) {
      if (u >= 0 && u != index && std::find(unit.after.begin(), unit.after.end(), u) == unit.after.end())
        unit.after.push_back(u);
    };
    for (int u = 0; u < index; ++u)
      if (unit.domain >= 0 && plan_.units[at(u)].domain == unit.domain) after(u);
    const auto reads = [&](int n) {
      for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way) { after(plan_.unit[at(source.node)]); });
    };
    for (const int n : unit.nodes) plan_.unit[at(n)] = index;
    if (unit.opens) plan_.unit[at(unit.domain)] = index, reads(unit.domain);
    for (const int n : unit.nodes) reads(n);
    if (unit.domain >= 0) unit.runs = runs(unit.nodes);
    plan_.units.push_back(std::move(unit));
  }

  /// The nodes of its own sweep that a node waits for, each once.
  std::vector<int> awaited(int n) const {
    std::vector<int> nodes;
    for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way w) {
      const bool own =
          w == Way::item && !node(source.node).type->makes_stream && plan_.unit[at(source.node)] == plan_.unit[at(n)];
      if (own && std::find(nodes.begin(), nodes.end(), source.node) == nodes.end()) nodes.push_back(source.node);
    });
    return nodes;
  }

  std::vector<Plan::Run> runs(const std::vector<int>& nodes) const {
    std::vector<int> waiting(graph_.nodes.size(), 0), run(graph_.nodes.size(), -1);
    for (const int n : nodes)
      for (const int m : awaited(n)) ++waiting[at(m)];
    std::vector<Plan::Run> all;
    for (const int n : nodes) {
      const auto before = awaited(n);
      if (before.size() == 1 && waiting[at(before[0])] == 1) {
        run[at(n)] = run[at(before[0])];
      } else {
        run[at(n)] = static_cast<int>(all.size());
        all.emplace_back();
        for (const int m : before) all.back().after.push_back(run[at(m)]);
      }
      all[at(run[at(n)])].nodes.push_back(n);
    }
    return all;
  }

  const Graph& graph_;
  std::vector<bool> gathered_;
  Plan plan_;
};

}  // namespace

Way way(const Graph& graph, const Graph::Wire& wire, const Graph::Port& source) {
  if (graph.nodes[static_cast<std::size_t>(source.node)].output_domain(source.node) < 0) return Way::single;
  return wire.gathers_stream ? Way::gathered : Way::item;
}

Plan make_plan(const Graph& graph) { return Planner(graph).plan(); }

}  // namespace talkgraph
