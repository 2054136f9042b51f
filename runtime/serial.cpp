#include "runtime/executors.h"
#include "runtime/plan.h"

namespace talkgraph {
namespace {

using Row = std::vector<Value>;  // one value an output port

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<RunResult::Output> run_serial(const Graph& graph, Caller& caller) {
  const std::size_t count = graph.nodes.size();
  std::vector<std::vector<Row>> rows(count);  // of each node, one an item
  std::vector<Keys> keys(count);              // of each source
  std::vector<std::size_t> last_reader(count);
  for (std::size_t n = 0; n < count; ++n)
    for_each_source(graph, static_cast<int>(n),
                    [&](std::size_t, Graph::Port source, Way) { last_reader[at(source.node)] = n; });
  for (const auto& output : graph.outputs) last_reader[at(output.source.node)] = count;

  const auto single = [&](Graph::Port p) { return rows[at(p.node)].at(0)[at(p.port)]; };
  const auto gathered = [&](Graph::Port p) {
    const auto& all = rows[at(p.node)];
    const auto& names = keys[at(graph.nodes[at(p.node)].output_domain(p.node))];
    auto items = std::make_shared<std::vector<Item<Value>>>();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i][at(p.port)]) items->push_back({names[i], all[i][at(p.port)]});
    return Gathered{all.size(), items};
  };

  for (std::size_t n = 0; n < count; ++n) {
    const auto& node = graph.nodes[n];
    const int self = static_cast<int>(n);
    auto fixed = caller.fixed_inputs(self, single, gathered);
    if (node.type->makes_stream) {
      OpenSource source(caller, self, std::move(fixed), keys[n]);
      while (auto values = source.next()) rows[n].push_back(std::move(*values));
      caller.domain_size(self, keys[n].size());
    } else if (node.domain < 0) {
      rows[n].push_back(std::move(caller.call(caller.station(self, std::move(fixed)), "")));
    } else {
      auto& station = caller.station(self, std::move(fixed));
      const auto& names = keys[at(node.domain)];
      rows[n].reserve(names.size());
      for (std::size_t i = 0; i < names.size(); ++i) {
        for_each_source(graph, self, [&](std::size_t input, Graph::Port source, Way w) {
          if (w == Way::item) station.give(input, rows[at(source.node)][i][at(source.port)]);
        });
        rows[n].push_back(std::move(caller.call(station, names[i])));
      }
      station.inputs.clear();
    }
    for (std::size_t m = 0; m <= n; ++m)
      if (last_reader[m] == n) rows[m].clear();
  }

  std::vector<RunResult::Output> outputs;
  for (const auto& output : graph.outputs) {
    RunResult::Output out{
        output.name, graph.nodes[at(output.source.node)].output_domain(output.source.node) >= 0, {}, {}};
    if (out.stream)
      out.items = *gathered(output.source).values;
    else
      out.value = single(output.source);
    outputs.push_back(std::move(out));
  }
  return outputs;
}

}  // namespace talkgraph
