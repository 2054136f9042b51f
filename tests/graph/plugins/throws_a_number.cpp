#include "graph/plugin.h"

TALKGRAPH_PLUGIN([](talkgraph::Registry&) { throw 42; })
