#include "runtime/recipe.h"

#include <fmt/format.h>

namespace talkgraph {
namespace {

Json content_of(const Json& path) {
  if (path.is_array()) {
    Json all = Json::array();
    for (const auto& one : path) all.push_back(content_of(one));
    return all;
  }
  const auto name = path.is_string() ? path.get<std::string>() : std::string();
  return name.empty() ? Json() : Json(file_key(name).str());
}

Json canonical(const Json& params, const std::vector<ParameterSpec>& specs);

Json canonical(const Json& value, const ParameterSpec& spec) {
  if (spec.type.ends_with("path")) return content_of(value);
  if (spec.members.empty()) return value;
  if (value.is_object()) return canonical(value, spec.members);
  Json all = value;
  for (auto& one : all) one = canonical(one, spec);
  return all;
}

/// Paths give way to what lies there.
Json canonical(const Json& params, const std::vector<ParameterSpec>& specs) {
  Json out = Json::object();
  for (const auto& spec : specs) out[spec.name] = canonical(params.value(spec.name, Json()), spec);
  return out;
}

std::string name_of(const PortType& type) { return fmt::format("{} {}", type.name, type.version); }

/// The type of what arrives at an input: of its source, where the input takes any.
PortType taken(const Graph& graph, const Graph::Node& node, std::size_t port) {
  const auto& type = node.type->inputs[port].type;
  if (type != any_type) return type;
  const auto& source = node.inputs[port].sources.front();
  return graph.nodes[static_cast<std::size_t>(source.node)].type->outputs[static_cast<std::size_t>(source.port)].type;
}

}  // namespace

Json recipe(const Graph& graph, int index) {
  const auto& node = graph.nodes[static_cast<std::size_t>(index)];
  Json out = {{"type", node.type->name}, {"version", node.type->version}};
  for (std::size_t p = 0; p < node.type->inputs.size(); ++p)
    out["inputs"][node.type->inputs[p].name] = name_of(taken(graph, node, p));
  for (const auto& port : node.type->outputs) out["outputs"][port.name] = name_of(port.type);
  out["params"] = canonical(node.functor->parameters(), node.type->parameters);
  if (node.type->uses_random) out["seed"] = graph.seed;
  if (node.type->uses_provenance) out["provenance"] = KeyMaker().add(provenance(graph, index).graph).key().str();
  return out;
}

}  // namespace talkgraph
