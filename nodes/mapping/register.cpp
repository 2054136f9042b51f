#include "nodes/mapping/register.h"

#include "nodes/mapping/context_gp.h"
#include "nodes/mapping/context_gp_inspect.h"
#include "nodes/mapping/context_gp_predict.h"
#include "nodes/mapping/coupled_hmm.h"
#include "nodes/mapping/coupled_hmm_synthesise.h"
#include "nodes/mapping/dpds.h"
#include "nodes/mapping/dpds_decode.h"
#include "nodes/mapping/dpds_synthesise.h"
#include "nodes/mapping/joint_gmm.h"
#include "nodes/mapping/offsets.h"
#include "nodes/mapping/phone_gaussians.h"
#include "nodes/mapping/resegment.h"
#include "nodes/mapping/shared_lds.h"
#include "nodes/mapping/shared_lds_synthesise.h"
#include "nodes/mapping/slds.h"
#include "nodes/mapping/slds_decode.h"
#include "nodes/mapping/slds_synthesise.h"
#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/ssgpdm_synthesise.h"
#include "nodes/mapping/trajectory_hmm.h"
#include "nodes/mapping/trajectory_hmm_synthesise.h"
#include "nodes/mapping/voice_puppetry.h"
#include "nodes/mapping/voice_puppetry_synthesise.h"
#include "nodes/mapping/windowed_cca.h"

namespace talkgraph {

void register_mapping(Registry& registry) {
  registry.add<AssembleSsgpdm>();
  registry.add<DecodeDpds>();
  registry.add<DecodeSlds>();
  registry.add<EstimateOffsets>();
  registry.add<InspectContextGp>();
  registry.add<PredictContextGp>();
  registry.add<Resegment>();
  registry.add<SynthesiseCoupledHmm>();
  registry.add<SynthesiseDpds>();
  registry.add<SynthesiseJointGmm>();
  registry.add<SynthesisePhoneGaussians>();
  registry.add<SynthesiseSharedLds>();
  registry.add<SynthesiseSlds>();
  registry.add<SynthesiseSsgpdm>();
  registry.add<SynthesiseTrajectoryHmm>();
  registry.add<SynthesiseVoicePuppetry>();
  registry.add<SynthesiseWindowedCca>();
  registry.add<TrainContextGp>();
  registry.add<TrainCoupledHmm>();
  registry.add<TrainDpds>();
  registry.add<TrainJointGmm>();
  registry.add<TrainPhoneGaussians>();
  registry.add<TrainSharedLds>();
  registry.add<TrainSlds>();
  registry.add<TrainTrajectoryHmm>();
  registry.add<TrainVoicePuppetry>();
  registry.add<TrainWindowedCca>();
}

}  // namespace talkgraph
