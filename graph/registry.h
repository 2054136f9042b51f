#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "graph/description.h"

namespace talkgraph {

/// The node types that graphs may name. A family fills it through a function
/// of its own, `void register_speech(Registry&)`; nothing registers by itself.
class Registry {
 public:
  /// Adds a node type from its `describe`. Throws std::logic_error on a
  /// duplicate name, an incomplete description, or a port type whose name
  /// belongs to another C++ type.
  template <class N>
  void add() {
    Description<N> description;
    describe(description);
    add(std::move(description).finish());
  }
  void add(NodeType type);

  const NodeType* find(const std::string& name) const;
  std::vector<std::string> names() const;
  /// The types of all ports, each once.
  const std::vector<PortType>& port_types() const { return port_types_; }

 private:
  void add_port(const PortSpec& port);

  std::map<std::string, NodeType> types_;
  std::vector<PortType> port_types_;
  std::map<std::string_view, const std::type_info*> cpp_;  ///< of port types, by their names
};

}  // namespace talkgraph
