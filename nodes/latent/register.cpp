#include "nodes/latent/register.h"

#include "nodes/latent/gmm.h"
#include "nodes/latent/gp_regression.h"
#include "nodes/latent/gpdm.h"
#include "nodes/latent/gpdm_infer.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/lds.h"
#include "nodes/latent/linear_models.h"
#include "nodes/latent/log_likelihood.h"
#include "nodes/latent/mrd.h"
#include "nodes/latent/sgpdm.h"

namespace talkgraph {

void register_latent(Registry& registry) {
  registry.add<TrainGp>();
  registry.add<PredictGp>();
  registry.add<TrainGpdm>();
  registry.add<InferGpdm>();
  registry.add<TrainMrd>();
  registry.add<TrainSgpdm>();
  registry.add<TrainPpca>();
  registry.add<ProjectPpca>();
  registry.add<TrainCca>();
  registry.add<ProjectCca>();
  registry.add<TrainPcca>();
  registry.add<ProjectPcca>();
  registry.add<TrainGmm>();
  registry.add<GmmResponsibilities>();
  registry.add<TrainHmm>();
  registry.add<DecodeHmm>();
  registry.add<TrainLds>();
  registry.add<SmoothLds>();
  registry.add<LogLikelihood>();
}

}  // namespace talkgraph
