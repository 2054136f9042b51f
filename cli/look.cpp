#include "cli/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "graph/differences.h"

namespace talkgraph::cli {
namespace {

std::string port_line(const PortSpec& port, bool input, bool stream) {
  std::string type(port.type.name);
  if (port.kind == PortSpec::Kind::collected) type = "all of a stream of " + type;
  if (port.kind == PortSpec::Kind::optional) type += ", optional";
  if (!input && stream) type = "stream of " + type;
  if (port.may_drop) type += ", may be absent";
  return fmt::format("    {:<14} {}{}\n", port.name, type, port.doc.empty() ? "" : ": " + port.doc);
}

std::string limits(const Range& range) {
  const bool low = range.low > -1e300, high = range.high < 1e300;
  if (low && high) return fmt::format(", {} to {}", range.low, range.high);
  if (low) return fmt::format(", {} {}", range.low_open ? "above" : "at least", range.low);
  if (high) return fmt::format(", at most {}", range.high);
  return "";
}

void parameter_lines(const std::vector<ParameterSpec>& specs, const std::string& indent, std::string& out) {
  for (const auto& p : specs) {
    std::string kind = p.choices.empty() ? p.type : fmt::format("{}", fmt::join(p.choices, " | "));
    out += fmt::format("{}{:<14} {}{}{}; {}\n", indent, p.name, kind, p.unit.empty() ? "" : ", " + p.unit,
                       limits(p.range), p.required ? "required" : "default " + p.initial.dump());
    if (!p.doc.empty()) out += fmt::format("{}{:<14}   {}\n", indent, "", p.doc);
    parameter_lines(p.members, indent + "  ", out);
  }
}

std::string example(const NodeType& type) {
  const auto name = type.name.substr(type.name.rfind('.') + 1);
  std::string in;
  for (const auto& port : type.inputs) in += fmt::format("{}\"{}\": \"NODE.PORT\"", in.empty() ? "" : ", ", port.name);
  std::string params;
  for (const auto& p : type.parameters)
    if (p.required) params += fmt::format("{}\"{}\": {}", params.empty() ? "" : ", ", p.name, p.initial.dump());
  return fmt::format("    \"{}\": {{ \"type\": \"{}\"{}{} }}\n", name, type.name,
                     in.empty() ? "" : ", \"in\": { " + in + " }",
                     params.empty() ? "" : ", \"params\": { " + params + " }");
}

std::string edge_type(const Graph& graph, const Graph::Port& port) {
  const auto& node = graph.nodes[static_cast<std::size_t>(port.node)];
  return std::string(node.type->outputs[static_cast<std::size_t>(port.port)].type.name);
}

bool is_stream(const Graph& graph, const Graph::Port& port) {
  return graph.nodes[static_cast<std::size_t>(port.node)].output_domain(port.node) >= 0;
}

/// Whether a text holds a word, in capitals or not.
bool speaks_of(const std::string& text, const std::string& word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(),
                     [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); }) != text.end();
}

template <class Visit>
void each_edge(const Graph& graph, Visit visit) {
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    for (const auto& wire : graph.nodes[i].inputs)
      for (const auto& source : wire.sources) visit(source, i);
}

}  // namespace

std::string list_nodes(const Registry& registry, const std::string& word) {
  std::string out;
  for (const auto& name : registry.names()) {
    const NodeType& type = *registry.find(name);
    if (!speaks_of(name, word) && !speaks_of(type.summary, word)) continue;
    out += fmt::format("{:<28} {}\n", name, type.summary);
  }
  if (out.empty()) throw std::invalid_argument(fmt::format("no node type speaks of \"{}\"", word));
  return out;
}

std::string show_node(const Registry& registry, const std::string& name) {
  const NodeType* type = registry.find(name);
  if (!type) {
    std::string hint = did_you_mean(name, registry.names());
    for (const auto& known : registry.names())
      if (hint.empty() && known.ends_with("." + name)) hint = fmt::format(" (did you mean \"{}\"?)", known);
    throw std::invalid_argument(fmt::format("unknown node type \"{}\"{}", name, hint));
  }
  std::string out = fmt::format("{} (version {}): {}\n", type->name, type->version, type->summary);
  if (!type->source.empty()) out += fmt::format("  source: {}\n", type->source);
  if (type->uses_random) out += "  draws random numbers from the graph's seed\n";
  if (!type->inputs.empty()) out += "  inputs\n";
  for (const auto& port : type->inputs) out += port_line(port, true, false);
  out += "  outputs\n";
  for (const auto& port : type->outputs) out += port_line(port, false, type->makes_stream);
  if (!type->parameters.empty()) out += "  parameters\n";
  parameter_lines(type->parameters, "    ", out);
  return out + "  example\n" + example(*type);
}

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
