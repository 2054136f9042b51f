#include "nodes/report/register.h"

#include "nodes/report/write.h"

namespace talkgraph {

void register_report(Registry& registry) { registry.add<WriteReport>(); }

}  // namespace talkgraph
