#include "nodes/report/register.h"

#include "nodes/report/latent_page.h"
#include "nodes/report/write.h"

namespace talkgraph {

void register_report(Registry& registry) {
  registry.add<LatentPage>();
  registry.add<WriteReport>();
}

}  // namespace talkgraph
