#include "nodes/sync/register.h"

#include "nodes/sync/direct.h"
#include "nodes/sync/frames.h"
#include "nodes/sync/median.h"
#include "nodes/sync/polyphase.h"
#include "nodes/sync/quadrature.h"
#include "nodes/sync/shift.h"
#include "nodes/sync/together.h"

namespace talkgraph {

void register_sync(Registry& registry) {
  registry.add<DirectSync>();
  registry.add<MedianSync>();
  registry.add<Polyphase>();
  registry.add<Quadrature>();
  registry.add<Shift>();
  registry.add<Together>();
  registry.add<VideoFrames>();
}

}  // namespace talkgraph
