#include "nodes/statistics/register.h"

#include "nodes/statistics/methods.h"

namespace talkgraph {

void register_statistics(Registry& registry) { registry.add<CompareMethods>(); }

}  // namespace talkgraph
