#include "nodes/speaker/register.h"

#include <utility>

#include "nodes/speaker/builtin.h"

namespace talkgraph {
namespace {

/// The node type, whose parameters are also looked at together when a graph is checked.
NodeType checked_speaker() {
  Description<BuiltinSpeaker> description;
  describe(description);
  NodeType type = std::move(description).finish();
  type.make = [make = type.make, specs = type.parameters](const LocatedJson* params, const Place& place,
                                                          const std::string& subject, Diagnostics& diagnostics) {
    BuiltinSpeaker node;
    Diagnostics of_each;
    detail::read_parameters(params, place, &node, specs, subject, of_each);
    const auto why = complaint(node);
    if (of_each.ok() && !why.empty())
      diagnostics.error(params ? params->place : place, fmt::format("{}: {}", subject, why));
    return make(params, place, subject, diagnostics);
  };
  return type;
}

}  // namespace

void register_speaker(Registry& registry) { registry.add(checked_speaker()); }

}  // namespace talkgraph
