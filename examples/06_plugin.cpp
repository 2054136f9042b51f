// 6. The shared library: talkgraph --plugin libmy_nodes.so run 06_graph.json
#include "06_nodes.h"
#include "graph/plugin.h"

TALKGRAPH_PLUGIN(mine::add_nodes)
