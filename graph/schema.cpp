#include "graph/schema.h"

#include <fmt/format.h>

namespace talkgraph {
namespace {

constexpr const char* parameter_pattern = R"(^\$\{[^}]+\}$)";

Json refer(const std::string& definition) { return {{"$ref", "#/definitions/" + definition}}; }

Json text(std::string description) { return {{"type", "string"}, {"description", std::move(description)}}; }

Json object(Json properties, const std::vector<std::string>& required = {}) {
  Json out = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) out["required"] = required;
  return out;
}

Json object_of(Json value) { return {{"type", "object"}, {"additionalProperties", std::move(value)}}; }

void set_range(Json& schema, const Range& range) {
  if (std::isfinite(range.low)) schema[range.low_open ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high)) schema["maximum"] = range.high;
}

Json parameters_schema(const std::vector<ParameterSpec>& specs);
Json given_schema(const std::string& type, const ParameterSpec& spec);

/// Of a value written out; `type` as in ParameterSpec.
Json value_schema(const std::string& type, const ParameterSpec& spec) {
  const std::string list = "list of ";
  if (type.starts_with(list)) return {{"type", "array"}, {"items", given_schema(type.substr(list.size()), spec)}};
  if (type == "boolean") return {{"type", "boolean"}};
  if (type == "choice") return {{"enum", spec.choices}};
  if (type == "object") return parameters_schema(spec.members);
  if (type == "graph") return object({{"graph", text("a graph file")}, {"params", object_of(true)}}, {"graph"});
  if (type == "ratio" || type == "integer" || type == "number") {
    Json number = {{"type", type == "ratio" ? "number" : type}};
    set_range(number, spec.range);
    return number;
  }
  return {{"type", "string"}};
}

/// Of a value written out, or the name of a graph's parameter. A limit of numbers does not bind texts, nor a pattern of
/// texts numbers, so one schema holds both and a validator can say which limit was passed.
Json given_schema(const std::string& type, const ParameterSpec& spec) {
  Json out = value_schema(type, spec);
  if (type == "choice") return {{"anyOf", {std::move(out), refer("parameter")}}};
  if (out["type"] == "string") return out;
  out["type"] = {out["type"], "string"};
  if (type == "ratio")
    out["pattern"] = R"(^(\$\{[^}]+\}|[-+]?\d+(\.\d+)?(/\d+)?)$)";
  else if (type != "graph")
    out["pattern"] = parameter_pattern;
  return out;
}

Json parameter_schema(const ParameterSpec& spec) {
  Json out = given_schema(spec.type, spec);
  if (spec.initial.is_null() && !spec.required && out.value("type", Json()).is_array()) out["type"].push_back("null");
  std::string doc = spec.doc;
  if (!spec.unit.empty()) doc += fmt::format("{}[{}]", doc.empty() ? "" : " ", spec.unit);
  if (!doc.empty()) out["description"] = doc;
  if (!spec.required) out["default"] = spec.initial;
  return out;
}

Json parameters_schema(const std::vector<ParameterSpec>& specs) {
  Json properties = Json::object();
  std::vector<std::string> required;
  for (const auto& spec : specs) {
    properties[spec.name] = parameter_schema(spec);
    if (spec.required) required.push_back(spec.name);
  }
  return object(std::move(properties), required);
}

Json port_schema(const PortSpec& port) {
  const bool collects = port.kind == PortSpec::Kind::collected;
  std::string description =
      collects ? fmt::format("all of a stream of {}, or several by name", port.type.name) : std::string(port.type.name);
  if (!port.doc.empty()) description += ": " + port.doc;
  Json out = refer(collects ? "collected" : "source");
  // Beside a $ref nothing counts in draft 7.
  return {{"description", description}, {"allOf", {std::move(out)}}};
}

std::string names_of(const std::vector<PortSpec>& ports) {
  std::string names;
  for (const auto& port : ports)
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", port.name, port.type.name);
  return names;
}

Json node_schema(const NodeType& type) {
  Json in = Json::object();
  std::vector<std::string> wired;
  for (const auto& port : type.inputs) {
    in[port.name] = port_schema(port);
    if (port.kind != PortSpec::Kind::optional) wired.push_back(port.name);
  }
  const bool has_required =
      std::any_of(type.parameters.begin(), type.parameters.end(), [](const ParameterSpec& p) { return p.required; });
  std::vector<std::string> required = {"type"};
  if (!wired.empty()) required.emplace_back("in");
  if (has_required) required.emplace_back("params");
  Json out = object({{"type", {{"const", type.name}}},
                     {"description", text("for readers")},
                     {"in", object(std::move(in), wired)},
                     {"params", parameters_schema(type.parameters)}},
                    required);
  out["description"] = fmt::format("{}. Gives {}.", type.summary, names_of(type.outputs));
  return out;
}

/// By the type that a node names, so that an editor complains of that node's parameters and no other's.
Json any_node(const Registry& registry) {
  Json types = Json::array(), cases = Json::array();
  for (const auto& name : registry.names()) {
    types.push_back({{"const", name}, {"description", registry.find(name)->summary}});
    cases.push_back({{"if", {{"properties", {{"type", {{"const", name}}}}}, {"required", {"type"}}}},
                     {"then", refer("node:" + name)}});
  }
  cases.push_back({{"if", {{"required", {"graph"}}, {"not", {{"required", {"like"}}}}}}, {"then", refer("graphNode")}});
  return {{"type", "object"},
          {"properties",
           {{"like", text("another node here, whose members are its own where it does not say otherwise")},
            {"type", {{"description", "node type; talkgraph nodes lists them"}, {"anyOf", types}}},
            {"graph", text("a graph file, used as a node")},
            {"description", text("for readers")},
            {"in", {{"type", "object"}}},
            {"params", {{"type", "object"}}}}},
          {"anyOf", {{{"required", {"type"}}}, {{"required", {"graph"}}}, {{"required", {"like"}}}}},
          {"not", {{"required", {"type", "graph"}}}},
          {"allOf", cases}};
}

Json input_types(const Registry& registry) {
  Json names = Json::array();
  for (const auto& type : registry.port_types()) {
    names.push_back(type.name);
    names.push_back(fmt::format("Stream<{}>", type.name));
  }
  return {{"enum", names}};
}

}  // namespace

Json json_schema(const Registry& registry) {
  Json definitions = {
      {"parameter", {{"type", "string"}, {"pattern", parameter_pattern}, {"description", "a parameter of the graph"}}},
      {"source", text("NODE.PORT, or NODE where it has one output, or inputs.NAME")},
      {"collected", {{"anyOf", {refer("source"), object_of(refer("source"))}}}},
      {"inputType", input_types(registry)},
      {"graphNode", object({{"graph", text("a graph file, from the folder of this one")},
                            {"description", text("for readers")},
                            {"in", object_of({{"anyOf", {refer("source"), object_of(refer("source"))}}})},
                            {"params", object_of(true)}},
                           {"graph"})},
      {"node", any_node(registry)}};
  for (const auto& name : registry.names()) definitions["node:" + name] = node_schema(*registry.find(name));
  const Json parameter = object({{"default", Json(true)}, {"doc", text("what it is")}});
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "talkgraph graph"},
                 {"description", "Nodes and how they are wired; docs/graphs.md explains"}};
  schema.update(object(
      {{"$schema", text("this schema")},
       {"extends", text("a graph file that this one is laid over: members are merged, null takes one away")},
       {"description", text("what the graph does")},
       {"parameters", {{"type", "object"}}},
       {"inputs", object_of({{"anyOf",
                              {refer("inputType"), object({{"type", refer("inputType")},
                                                           {"optional", {{"type", "boolean"}}},
                                                           {"doc", text("what it is")}},
                                                          {"type"})}}})},
       {"nodes", {{"type", "object"}, {"propertyNames", {{"pattern", "^[^. ]+$"}, {"not", {{"const", "inputs"}}}}}}},
       {"outputs", {{"type", "object"}}},
       {"seed", {{"anyOf", {{{"type", "integer"}, {"minimum", 0}}, refer("parameter")}}, {"default", 1}}}},
      {}));
  // What is laid over another graph holds parts of nodes, and null for what it takes away.
  schema["if"] = {{"required", {"extends"}}};
  schema["then"]["properties"] = {{"parameters", object_of({{"anyOf", {parameter, {{"type", "null"}}}}})},
                                  {"nodes", object_of({{"type", {"object", "null"}}})},
                                  {"outputs", object_of({{"type", {"string", "null"}}})}};
  schema["else"] = {{"properties",
                     {{"parameters", object_of(parameter)},
                      {"nodes", object_of(refer("node"))},
                      {"outputs", object_of(refer("source"))}}},
                    {"required", {"nodes"}}};
  schema["definitions"] = std::move(definitions);
  return schema;
}

}  // namespace talkgraph
