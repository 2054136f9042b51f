#include "nodes/model/register.h"

#include "nodes/model/load.h"
#include "nodes/model/save.h"

namespace talkgraph {

void register_model(Registry& registry) {
  registry.add<LoadModel>();
  registry.add<SaveModel>();
}

}  // namespace talkgraph
