#include "cli/example.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "graph/graph.h"

namespace talkgraph::cli {
namespace {

const Json& examples() {
  static const Json graph = Json::parse(
#include "cli/examples.inc"
  );
  return graph["nodes"];
}

/// The first node of a type among the examples, or nothing.
std::string name_among_examples(const std::string& type) {
  for (const auto& [name, node] : examples().items())
    if (node["type"] == type) return name;
  return "";
}

std::string node_of(const std::string& source) { return source.substr(0, source.rfind('.')); }

/// What is wired to the inputs of a node.
std::vector<std::string> sources_of(const Json& node) {
  std::vector<std::string> sources;
  const Json in = node.value("in", Json::object());
  for (const auto& wire : in)
    if (wire.is_object())
      for (const auto& source : wire) sources.push_back(source);
    else
      sources.push_back(wire);
  return sources;
}

/// A value that a required parameter may have.
Json any_value(const ParameterSpec& spec, const std::string& type) {
  const std::string list = "list of ";
  if (type.starts_with(list)) return Json::array({any_value(spec, type.substr(list.size()))});
  if (!spec.choices.empty()) return spec.choices.front();
  if (type == "boolean") return true;
  if (type == "text") return "text";
  if (type == "path") return "file";
  if (type != "integer" && type != "number" && type != "ratio") return spec.initial;
  const double number = std::clamp(1.0, spec.range.low + (spec.range.low_open ? 1 : 0), spec.range.high);
  return type == "integer" ? Json(static_cast<std::int64_t>(std::ceil(number))) : Json(number);
}

/// Adds one of the examples to `nodes`, behind all that it needs.
void take(const std::string& name, Json& nodes) {
  if (nodes.contains(name)) return;
  for (const auto& source : sources_of(examples().at(name))) take(node_of(source), nodes);
  nodes[name] = examples()[name];
}

/// Puts an example together. `nodes` holds a node behind those that feed it.
class Example {
 public:
  explicit Example(const Registry& registry) : registry_(registry) {}

  Json nodes = Json::object();

  /// A node of a type, with all that it needs; gives its name.
  std::string add(const NodeType& type) {
    std::string name = name_among_examples(type.name);
    if (name.empty()) return make_up(type, type.makes_stream);
    return take(name, nodes), name;
  }

  /// A node that writes a file of what another gives, as the examples do it for such a stream or single value, or at
  /// all; gives its name, or nothing.
  std::string add_sink(const NodeType& type, const std::string& name) {
    for (const bool alike : {true, false})
      for (const auto& port : type.outputs)
        for (const auto& [sink, example] : examples().items()) {
          const NodeType* known = registry_.find(example["type"]);
          const PortSpec* input = known && known->sink ? only_input(*known) : nullptr;
          if (!input || input->type != port.type || nodes.contains(sink)) continue;
          if (alike && is_stream(sink, examples()) != is_stream(name, nodes)) continue;
          nodes[sink] = example;
          nodes[sink]["in"] = {{input->name, name + "." + port.name}};
          return sink;
        }
    return "";
  }

 private:
  /// The one input that must be wired, or nothing if there are more or it collects.
  static const PortSpec* only_input(const NodeType& type) {
    const PortSpec* only = nullptr;
    for (const auto& port : type.inputs) {
      if (port.kind == PortSpec::Kind::optional) continue;
      if (only || port.kind == PortSpec::Kind::collected) return nullptr;
      only = &port;
    }
    return only;
  }

  /// `single`: it must not run once an item.
  std::string make_up(const NodeType& type, bool single) {
    open_.insert(type.name);
    Json node = {{"type", type.name}};
    for (const auto& port : type.inputs)
      if (port.kind != PortSpec::Kind::optional) node["in"][port.name] = wire(type, port, single);
    for (const auto& spec : type.parameters)
      if (spec.required) node["params"][spec.name] = any_value(spec, spec.type);
    open_.erase(type.name);
    std::string name = type.name;
    std::replace(name.begin(), name.end(), '.', '_');
    nodes[name] = std::move(node);
    return name;
  }

  Json wire(const NodeType& type, const PortSpec& port, bool single) {
    const bool collects = port.kind == PortSpec::Kind::collected;
    const std::string source = find_source(port.type, single && !collects);
    if (source.empty())
      throw std::runtime_error(fmt::format("no example: nothing known gives {}, which {} takes as \"{}\"",
                                           port.type.name, type.name, port.name));
    return collects && !is_stream(node_of(source), nodes) ? Json{{"example", source}} : Json(source);
  }

  /// The first port that gives a type: among the examples, else of a type that they do not hold.
  std::string find_source(const PortType& type, bool single) {
    for (const auto& [name, node] : examples().items()) {
      const NodeType* known = registry_.find(node["type"]);
      const std::string port = known ? output_of(*known, type) : "";
      if (port.empty()) continue;
      if (single && is_stream(name, examples())) continue;
      take(name, nodes);
      return name + "." + port;
    }
    for (const auto& name : registry_.names()) {
      const NodeType& known = *registry_.find(name);
      const std::string port = output_of(known, type);
      if (port.empty() || (single && known.makes_stream) || open_.contains(name)) continue;
      return make_up(known, single || known.makes_stream) + "." + port;
    }
    return "";
  }

  static std::string output_of(const NodeType& node, const PortType& type) {
    for (const auto& port : node.outputs)
      if (port.type == type) return port.name;
    return "";
  }

  /// Whether a node gives a value an item.
  bool is_stream(const std::string& name, const Json& among) const {
    const Json& node = among[name];
    const NodeType* type = registry_.find(node["type"]);
    if (!type || type->makes_stream) return type != nullptr;
    return std::any_of(type->inputs.begin(), type->inputs.end(), [&](const PortSpec& port) {
      return port.kind != PortSpec::Kind::collected && node.contains("in") && node["in"].contains(port.name) &&
             is_stream(node_of(node["in"][port.name]), among);
    });
  }

  const Registry& registry_;
  std::set<std::string> open_;  ///< types whose inputs are being looked for
};

Json with_first(const Json& nodes, const std::string& first) {
  Json out = {{first, nodes[first]}};
  out.update(nodes);
  return out;
}

/// What is put together from types alone may still be unsound: streams that do not meet, a parameter with rules.
void check_made_up(const Json& graph, const Registry& registry, const NodeType& type) {
  Diagnostics diagnostics;
  if (!load_graph_text(type.name, graph.dump(), registry, diagnostics))
    throw std::runtime_error(fmt::format("no example: {} cannot be wired by its types alone", type.name));
}

/// Json on one line, with spaces.
std::string inline_text(const Json& json) {
  if (!json.is_structured() || json.empty()) return json.dump();
  std::string out;
  for (const auto& [key, value] : json.items())
    out += fmt::format("{}{}{}", out.empty() ? "" : ", ", json.is_object() ? Json(key).dump() + ": " : "",
                       inline_text(value));
  return json.is_object() ? "{ " + out + " }" : "[" + out + "]";
}

}  // namespace

Json example_nodes(const std::vector<std::string>& names) {
  Json nodes = Json::object();
  for (const auto& name : names) take(name, nodes);
  return nodes;
}

bool reads_samples(const Json& graph) { return graph.dump().find("\"samples/") != std::string::npos; }

Json example_graph(const Registry& registry, const NodeType& type) {
  Example example(registry);
  const std::string name = example.add(type);
  Json outputs = Json::object();
  for (const auto& port : type.outputs) outputs[port.name] = name + "." + port.name;
  if (!type.sink)
    if (const auto sink = example.add_sink(type, name); !sink.empty()) outputs[sink] = sink;
  Json graph = {{"description", fmt::format("{}: {}", type.name, type.summary)},
                {"nodes", with_first(example.nodes, name)},
                {"outputs", outputs}};
  if (name_among_examples(type.name).empty()) check_made_up(graph, registry, type);
  if (reads_samples(graph))
    graph["description"] = graph["description"].get<std::string>() + "; on files that `talkgraph samples` writes";
  return graph;
}

std::string graph_text(const Json& graph) {
  std::string nodes;
  for (const auto& [name, node] : graph["nodes"].items())
    nodes += fmt::format("{}    {}: {}", nodes.empty() ? "" : ",\n", Json(name).dump(), inline_text(node));
  return fmt::format("{{\n  \"description\": {},\n  \"nodes\": {{\n{}\n  }},\n  \"outputs\": {}\n}}\n",
                     graph["description"].dump(), nodes, inline_text(graph["outputs"]));
}

}  // namespace talkgraph::cli
