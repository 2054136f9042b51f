#include "graph/plugin.h"
#include "tests/graph/toy_nodes.h"

namespace {

using talkgraph::toy::Number;

/// Half of numbers that the program made; throws what the program catches by its type.
struct Halve {
  Number operator()(const Number& n) const {
    if (n.x < 0) throw talkgraph::Cancelled();
    return {n.x / 2};
  }
};
void describe(talkgraph::Description<Halve>& d) {
  d.type("good.halve").summary("half of it").input("n").output("half");
}

}  // namespace

TALKGRAPH_PLUGIN([](talkgraph::Registry& registry) { registry.add<Halve>(); })
