#include "graph/plugin.h"

// What a plugin built with another release looks like.
extern "C" talkgraph::Plugin talkgraph_plugin() {
  return {"talkgraph 0.0.1", [](talkgraph::Registry&) { throw std::logic_error("was called"); }};
}
