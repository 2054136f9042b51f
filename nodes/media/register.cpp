#include "nodes/media/register.h"

#include "nodes/media/check_video.h"
#include "nodes/media/resample.h"
#include "nodes/media/video.h"

namespace talkgraph {

void register_media(Registry& registry) {
  registry.add<OpenVideo>();
  registry.add<CheckVideo>();
  registry.add<Resample>();
}

}  // namespace talkgraph
