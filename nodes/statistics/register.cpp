#include "nodes/statistics/register.h"

#include "nodes/statistics/groups.h"
#include "nodes/statistics/methods.h"
#include "nodes/statistics/proportions.h"

namespace talkgraph {

void register_statistics(Registry& registry) {
  registry.add<CompareGroups>();
  registry.add<CompareMethods>();
  registry.add<Proportions>();
}

}  // namespace talkgraph
