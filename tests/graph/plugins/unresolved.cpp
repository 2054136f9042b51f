#include "graph/plugin.h"

// Stands for a function that this talkgraph does not have.
void gone(talkgraph::Registry& registry);

TALKGRAPH_PLUGIN(gone)
