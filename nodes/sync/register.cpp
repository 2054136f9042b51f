#include "nodes/sync/register.h"

#include "nodes/sync/frames.h"
#include "nodes/sync/median.h"
#include "nodes/sync/polyphase.h"

namespace talkgraph {

void register_sync(Registry& registry) {
  registry.add<MedianSync>();
  registry.add<Polyphase>();
  registry.add<VideoFrames>();
}

}  // namespace talkgraph
