#include "graph/plugin.h"

TALKGRAPH_PLUGIN([](talkgraph::Registry&) { throw std::runtime_error("no licence today"); })
