// 6. Registering: one function names all nodes. Here it serves a shared library (06_plugin.cpp) and a program of our
// own (07_program.cpp).
#pragma once

#include "01_first_node.h"
#include "02_parameters.h"
#include "03_training.h"
#include "04_source.h"
#include "graph/registry.h"

namespace mine {

inline void add_nodes(talkgraph::Registry& registry) {
  registry.add<Loudness>();
  registry.add<Scale>();
  registry.add<Smooth>();
  registry.add<LearnJaw>();
  registry.add<MoveJaw>();
  registry.add<Babble>();
}

}  // namespace mine
