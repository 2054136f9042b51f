#include "nodes/latent/register.h"

#include "nodes/latent/gp_regression.h"
#include "nodes/latent/gpdm.h"
#include "nodes/latent/mrd.h"
#include "nodes/latent/sgpdm.h"

namespace talkgraph {

void register_latent(Registry& registry) {
  registry.add<TrainGp>();
  registry.add<PredictGp>();
  registry.add<TrainGpdm>();
  registry.add<TrainMrd>();
  registry.add<TrainSgpdm>();
}

}  // namespace talkgraph
