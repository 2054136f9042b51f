#include "graph/description.h"

namespace talkgraph::detail {

void add_input(NodeType& type, std::span<const PortKind> kinds, std::string name, std::string doc) {
  const std::size_t next = type.inputs.size();
  if (next == kinds.size()) throw std::logic_error(type.name + ": more inputs described than the call operator takes");
  type.inputs.push_back(
      {std::move(name), std::move(doc), kinds[next].type, kinds[next].kind, false, nullptr, kinds[next].cpp});
}

void add_output(NodeType& type, PortSpec spec) { type.outputs.push_back(std::move(spec)); }

void check_described(const NodeType& type, std::size_t inputs) {
  if (type.name.empty() || type.summary.empty()) throw std::logic_error("a node description without type or summary");
  if (type.inputs.size() != inputs)
    throw std::logic_error(type.name + ": fewer inputs described than the call operator takes");
  if (type.outputs.empty()) throw std::logic_error(type.name + ": no output described");
}

void read_parameters(const LocatedJson* params, const Place& place, void* node, const std::vector<ParameterSpec>& specs,
                     const std::string& subject, Diagnostics& diagnostics) {
  LocatedJson none;
  none.kind = LocatedJson::Kind::object;
  none.place = place;
  read_struct(params ? *params : none, node, specs, subject, diagnostics);
}

}  // namespace talkgraph::detail
