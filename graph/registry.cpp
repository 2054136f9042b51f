#include "graph/registry.h"

#include <algorithm>

namespace talkgraph {

void Registry::add(NodeType type) {
  const auto name = type.name;
  for (const auto* ports : {&type.inputs, &type.outputs})
    for (const auto& port : *ports)
      if (port.type != any_type && std::find(port_types_.begin(), port_types_.end(), port.type) == port_types_.end())
        port_types_.push_back(port.type);
  if (!types_.emplace(name, std::move(type)).second) throw std::logic_error("two nodes of type " + name);
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
