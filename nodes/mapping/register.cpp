#include "nodes/mapping/register.h"

#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/ssgpdm_synthesise.h"

namespace talkgraph {

void register_mapping(Registry& registry) {
  registry.add<AssembleSsgpdm>();
  registry.add<SynthesiseSsgpdm>();
}

}  // namespace talkgraph
