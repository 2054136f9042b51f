#include "nodes/context/register.h"

#include "nodes/context/decode.h"
#include "nodes/context/inspect.h"
#include "nodes/context/perplexity.h"
#include "nodes/context/sample.h"
#include "nodes/context/segment.h"
#include "nodes/context/segment_online.h"
#include "nodes/context/train.h"
#include "nodes/context/windows.h"

namespace talkgraph {

void register_context(Registry& registry) {
  registry.add<ContextDecode>();
  registry.add<ContextPerplexity>();
  registry.add<ContextSample>();
  registry.add<ContextSegment>();
  registry.add<ContextSegmentOnline>();
  registry.add<ContextTrain>();
  registry.add<ContextWindows>();
  registry.add<InspectContexts>();
}

}  // namespace talkgraph
