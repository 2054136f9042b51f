#include "runtime/why.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "graph/differences.h"
#include "graph/output_file.h"
#include "runtime/plan.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

fs::path snapshot_file(const Cache& cache, const Graph& graph) {
  const auto key = KeyMaker().add(fs::weakly_canonical(graph.name).string()).key();
  return cache.folder() / "graphs" / (key.str() + ".json");
}

std::string port_name(const Graph& graph, Graph::Port port) {
  const auto& node = graph.nodes[static_cast<std::size_t>(port.node)];
  return node.name + "." + node.type->outputs[static_cast<std::size_t>(port.port)].name;
}

/// Compares a graph with what it was.
class Comparison {
 public:
  Comparison(const Graph& graph, const Json& before, const Json& now) : graph_(graph), before_(before), now_(now) {}

  /// Why a node must be called though it is kept: what differs at it, or else at the nodes it depends on.
  std::vector<std::string> causes(int node) const {
    if (before_.is_null()) return {"this graph has not run with this cache before"};
    std::vector<std::string> found = at_node(node);
    if (!found.empty()) return found;
    std::set<int> seen;
    upstream(node, seen, found);
    if (found.empty()) found.emplace_back("not in the cache: the last run did not get so far, or it was removed since");
    return found;
  }

 private:
  const std::string& name(int node) const { return graph_.nodes[static_cast<std::size_t>(node)].name; }

  std::vector<std::string> at_node(int node) const {
    const Json& nodes = before_["nodes"];
    if (!nodes.contains(name(node))) return {"the node is new"};
    std::vector<std::string> found = differences(nodes[name(node)], now_["nodes"][name(node)]);
    const Json items_before = before_["items"].value(name(node), Json::object());
    const Json items_now = now_["items"].value(name(node), Json::object());
    for (const auto& [item, key] : items_now.items()) {
      if (!items_before.contains(item))
        found.push_back(fmt::format("item \"{}\" is new", item));
      else if (items_before[item] != key)
        found.push_back(fmt::format("item \"{}\" has changed", item));
    }
    for (const auto& [item, key] : items_before.items())
      if (!items_now.contains(item)) found.push_back(fmt::format("item \"{}\" is gone", item));
    return found;
  }

  void upstream(int node, std::set<int>& seen, std::vector<std::string>& found) const {
    const auto& self = graph_.nodes[static_cast<std::size_t>(node)];
    const auto visit = [&](int source) {
      if (!seen.insert(source).second) return;
      const auto here = at_node(source);
      for (const auto& cause : here) found.push_back(fmt::format("{}: {}", name(source), cause));
      if (here.empty()) upstream(source, seen, found);
    };
    for_each_source(graph_, node, [&](std::size_t, Graph::Port source, Way) { visit(source.node); });
    if (self.domain >= 0) visit(self.domain);
  }

  const Graph& graph_;
  const Json& before_;
  const Json& now_;
};

/// The first few of a list.
std::string few(const std::vector<std::string>& all, const std::string& before) {
  constexpr std::size_t most = 4;
  std::string out;
  for (std::size_t i = 0; i < all.size() && i < most; ++i) out += before + all[i] + "\n";
  if (all.size() > most) out += fmt::format("{}and {} more\n", before, all.size() - most);
  return out;
}

std::string counts_text(const Forecast::Counts& counts) {
  std::string out;
  const auto put = [&](std::size_t n, const char* what) {
    if (n) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", n, what);
  };
  put(counts.call, "to compute");
  put(counts.load, "in the cache");
  put(counts.skip, "not needed");
  return out + (counts.foreseen ? "" : " (of items that only the run will know)");
}

}  // namespace

Json snapshot(const Graph& graph, const Forecast& forecast) {
  Json out = {{"graph", graph.name}, {"nodes", Json::object()}, {"items", Json::object()}};
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    const auto& node = graph.nodes[n];
    Json wires = Json::object();
    for (std::size_t p = 0; p < node.inputs.size(); ++p)
      for (const auto& source : node.inputs[p].sources)
        wires[node.type->inputs[p].name].push_back(port_name(graph, source));
    const Json recipe = forecast.recipe(static_cast<int>(n));
    out["nodes"][node.name] = {{"version", recipe.value("version", Json())},
                               {"type", node.type->name},
                               {"params", recipe.value("params", Json())},
                               {"seed", recipe.value("seed", Json())},
                               {"in", std::move(wires)}};
    if (!node.type->makes_stream) continue;
    Json items = Json::object();
    for (const auto& [item, key] : forecast.items(static_cast<int>(n))) items[item] = key.str();
    out["items"][node.name] = std::move(items);
  }
  return out;
}

void keep_snapshot(const Cache& cache, const Graph& graph, const Json& snapshot) {
  write_file(snapshot_file(cache, graph), snapshot.dump());
}

Json last_snapshot(const Cache& cache, const Graph& graph) {
  std::ifstream file(snapshot_file(cache, graph));
  const Json json = Json::parse(file, nullptr, false);
  return json.is_object() && json.contains("nodes") && json.contains("items") ? json : Json();
}

std::string explain(const Graph& graph, const Forecast& forecast, const Json& before,
                    const std::optional<std::string>& asked) {
  const Json now = snapshot(graph, forecast);
  const Comparison comparison(graph, before, now);
  std::string out;
  bool found = false;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const auto& node = graph.nodes[i];
    const int n = static_cast<int>(i);
    if (asked ? node.name != *asked : !node.type->stored && !node.type->sink) continue;
    found = true;
    const auto counts = forecast.counts(n);
    out += fmt::format("{:<28} {}\n", node.name, counts_text(counts));
    if (!node.type->stored && !node.type->sink)
      out += "    its results are not kept: it runs when another node needs them\n";
    if (counts.call) out += few(comparison.causes(n), "    because ");
    if (asked)
      for (const auto& [item, need] : forecast.needs(n))
        if (!item.empty())
          out += fmt::format("    {:<24} {}\n", item,
                             need == Need::call   ? "to compute"
                             : need == Need::load ? "in the cache"
                                                  : "not needed");
  }
  if (!found && asked) {
    std::vector<std::string> names;
    for (const auto& node : graph.nodes) names.push_back(node.name);
    throw std::invalid_argument(fmt::format("there is no node \"{}\"{}", *asked, did_you_mean(*asked, names)));
  }
  return out.empty() ? "this graph keeps nothing\n" : out;
}

}  // namespace talkgraph
