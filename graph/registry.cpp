#include "graph/registry.h"

#include <fmt/format.h>

namespace talkgraph {

void Registry::add(NodeType type) {
  const auto name = type.name;
  for (const auto* ports : {&type.inputs, &type.outputs})
    for (const auto& port : *ports) add_port(port);
  if (!types_.emplace(name, std::move(type)).second) throw std::logic_error("two nodes of type " + name);
}

void Registry::add_port(const PortSpec& port) {
  if (port.type == any_type) return;
  const auto [known, is_new] = cpp_.emplace(port.type.name, port.cpp);
  // Values are told apart by these names alone.
  if (!is_new && *known->second != *port.cpp)
    throw std::logic_error(fmt::format("the port type {} is two C++ types: {} and {}", port.type.name,
                                       known->second->name(), port.cpp->name()));
  if (is_new) port_types_.push_back(port.type);
}

const NodeType* Registry::find(const std::string& name) const {
  const auto it = types_.find(name);
  return it == types_.end() ? nullptr : &it->second;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> all;
  for (const auto& [name, type] : types_) all.push_back(name);
  return all;
}

}  // namespace talkgraph
