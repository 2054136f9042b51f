#include "cli/look.h"

#include <fmt/format.h>

#include "graph/differences.h"

namespace talkgraph::cli {
namespace {

std::string edge_type(const Graph& graph, const Graph::Port& port) {
  const auto& node = graph.nodes[static_cast<std::size_t>(port.node)];
  return std::string(node.type->outputs[static_cast<std::size_t>(port.port)].type.name);
}

bool is_stream(const Graph& graph, const Graph::Port& port) {
  return graph.nodes[static_cast<std::size_t>(port.node)].output_domain(port.node) >= 0;
}

template <class Visit>
void each_edge(const Graph& graph, Visit visit) {
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    for (const auto& wire : graph.nodes[i].inputs)
      for (const auto& source : wire.sources) visit(source, i);
}

}  // namespace

std::string diff_graphs(const Graph& a, const Graph& b) {
  Json before = a.resolved["nodes"], after = b.resolved["nodes"];
  std::string out;
  for (const auto& [name, node] : a.resolved["nodes"].items())
    if (!after.contains(name))
      out += fmt::format("- {} ({})\n", name, node["type"].get<std::string>()), before.erase(name);
  for (const auto& [name, node] : b.resolved["nodes"].items())
    if (!before.contains(name))
      out += fmt::format("+ {} ({})\n", name, node["type"].get<std::string>()), after.erase(name);
  for (const auto& difference : differences(before, after)) out += fmt::format("  {}\n", difference);
  for (const char* part : {"outputs", "seed"})
    for (const auto& difference : differences({{part, a.resolved[part]}}, {{part, b.resolved[part]}}))
      out += fmt::format("  {}\n", difference);
  return out;
}

std::string draw_dot(const Graph& graph) {
  std::string out =
      "digraph {\n  rankdir=LR;\n  node [shape=box, style=\"rounded,filled\", fillcolor=\"#eef3f8\", "
      "color=\"#5b7a99\", "
      "fontname=\"Helvetica\"];\n  edge [fontname=\"Helvetica\", fontsize=10, color=\"#5b7a99\"];\n";
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    out += fmt::format("  n{} [label=\"{}\\n{}\"{}];\n", i, graph.nodes[i].name, graph.nodes[i].type->name,
                       graph.nodes[i].type->makes_stream ? ", fillcolor=\"#fdf3dc\"" : "");
  each_edge(graph, [&](const Graph::Port& source, std::size_t to) {
    out += fmt::format("  n{} -> n{} [label=\"{}\"{}];\n", source.node, to, edge_type(graph, source),
                       is_stream(graph, source) ? ", penwidth=2.5" : "");
  });
  return out + "}\n";
}

std::string draw_mermaid(const Graph& graph) {
  std::string out = "flowchart LR\n";
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    out += fmt::format("  n{}[\"{}<br/><i>{}</i>\"]\n", i, graph.nodes[i].name, graph.nodes[i].type->name);
  each_edge(graph, [&](const Graph::Port& source, std::size_t to) {
    out += fmt::format("  n{} {}|{}| n{}\n", source.node, is_stream(graph, source) ? "==>" : "-->",
                       edge_type(graph, source), to);
  });
  return out;
}

}  // namespace talkgraph::cli
