#include "cli/look.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

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

/// Nodes, and the graphs used as nodes that they stood in, by name, in order.
struct Group {
  std::vector<std::pair<std::string, std::size_t>> nodes;
  std::vector<std::pair<std::string, Group>> groups;
};

/// Adds "hear/speech/mel" as "mel" in the group "speech" in the group "hear".
void add_to(Group& group, const std::string& name, std::size_t node) {
  const auto slash = name.find('/');
  if (slash == std::string::npos) return group.nodes.emplace_back(name, node), void();
  const std::string outer = name.substr(0, slash);
  auto inner = std::find_if(group.groups.begin(), group.groups.end(), [&](const auto& g) { return g.first == outer; });
  if (inner == group.groups.end()) inner = group.groups.insert(inner, {outer, {}});
  add_to(inner->second, name.substr(slash + 1), node);
}

Group group(const Graph& graph) {
  Group all;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) add_to(all, graph.nodes[i].name, i);
  return all;
}

template <class Open, class Node, class Close>
void each_part(const Group& group, const std::string& indent, const Open& open, const Node& node, const Close& close) {
  for (const auto& [name, index] : group.nodes) node(index, name, indent);
  for (const auto& [name, inner] : group.groups) {
    open(name, indent);
    each_part(inner, indent + "  ", open, node, close);
    close(indent);
  }
}

/// Text in quotes, its own quotes written in another way.
std::string quoted(const std::string& text, const std::string& quote) {
  std::string out;
  for (const char c : text) out += c == '"' ? quote : c == '\n' ? "\\n" : std::string(1, c);
  return '"' + out + '"';
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
      "digraph {\n  rankdir=LR;\n  newrank=true;\n  fontname=\"Helvetica\";\n"
      "  label=\"thick: a stream of items; yellow: makes a stream; green: writes files\";\n"
      "  node [shape=box, style=\"rounded,filled\", fillcolor=\"#eef3f8\", color=\"#5b7a99\", "
      "fontname=\"Helvetica\"];\n"
      "  edge [fontname=\"Helvetica\", fontsize=10, color=\"#5b7a99\"];\n";
  const auto escaped = [](const std::string& text) { return quoted(text, "\\\""); };
  int clusters = 0;
  each_part(
      group(graph), "  ",
      [&](const std::string& name, const std::string& indent) {
        out += fmt::format(
            "{}subgraph cluster_{} {{\n{}  label={};\n{}  style=\"rounded,filled\"; color=\"#b8c6d4\"; "
            "fillcolor=\"#5b7a9912\"; labeljust=l;\n",
            indent, clusters++, indent, escaped(name), indent);
      },
      [&](std::size_t i, const std::string& name, const std::string& indent) {
        const NodeType& type = *graph.nodes[i].type;
        const char* fill = type.makes_stream ? ", fillcolor=\"#fdf3dc\"" : type.sink ? ", fillcolor=\"#e3f1e1\"" : "";
        out += fmt::format("{}n{} [label={}{}];\n", indent, i, escaped(name + "\n" + type.name), fill);
      },
      [&](const std::string& indent) { out += indent + "}\n"; });
  each_edge(graph, [&](const Graph::Port& source, std::size_t to) {
    out += fmt::format("  n{} -> n{} [label=\"{}\"{}];\n", source.node, to, edge_type(graph, source),
                       is_stream(graph, source) ? ", penwidth=2.5" : "");
  });
  return out + "}\n";
}

std::string draw_svg(const Graph& graph) {
  char name[] = "/tmp/talkgraph-XXXXXX";
  const int file = mkstemp(name);
  if (file < 0) throw std::runtime_error("no temporary file can be made in /tmp");
  close(file);
  std::ofstream(name) << draw_dot(graph);
  std::string svg;
  // Graphviz 2.43 loses its way in some large graphs with nested boxes: then the boxes are laid out in the old way, or
  // left out.
  for (const char* command :
       {"dot -Tsvg {}", "sed /newrank/d {} | dot -Tsvg", "sed /newrank/d {} | dot -Tsvg -Gclusterrank=none"}) {
    std::FILE* dot = popen((fmt::format(fmt::runtime(command), name) + " 2>/dev/null").c_str(), "r");
    svg.clear();
    char part[4096];
    while (const auto n = std::fread(part, 1, sizeof part, dot)) svg.append(part, n);
    if (pclose(dot) == 0) break;
    svg.clear();
  }
  std::filesystem::remove(name);
  if (svg.empty()) throw std::runtime_error("Graphviz (dot) is not there, or failed; --format dot needs none");
  return svg;
}

std::string draw_mermaid(const Graph& graph) {
  std::string out = "flowchart LR\n";
  const auto escaped = [](const std::string& text) { return quoted(text, "#quot;"); };
  int groups = 0;
  each_part(
      group(graph), "  ",
      [&](const std::string& name, const std::string& indent) {
        out += fmt::format("{}subgraph g{}[{}]\n", indent, groups++, escaped(name));
      },
      [&](std::size_t i, const std::string& name, const std::string& indent) {
        out += fmt::format("{}n{}[{}]\n", indent, i, escaped(name + "<br/><i>" + graph.nodes[i].type->name + "</i>"));
      },
      [&](const std::string& indent) { out += indent + "end\n"; });
  each_edge(graph, [&](const Graph::Port& source, std::size_t to) {
    out += fmt::format("  n{} {}|\"{}\"| n{}\n", source.node, is_stream(graph, source) ? "==>" : "-->",
                       edge_type(graph, source), to);
  });
  return out;
}

}  // namespace talkgraph::cli
