#include "nodes/mapping/register.h"

#include "nodes/mapping/phone_gaussians.h"
#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/ssgpdm_synthesise.h"

namespace talkgraph {

void register_mapping(Registry& registry) {
  registry.add<AssembleSsgpdm>();
  registry.add<SynthesisePhoneGaussians>();
  registry.add<SynthesiseSsgpdm>();
  registry.add<TrainPhoneGaussians>();
}

}  // namespace talkgraph
