#include "nodes/normalise/register.h"

#include "nodes/normalise/ica.h"
#include "nodes/normalise/mean_center.h"
#include "nodes/normalise/mean_of.h"
#include "nodes/normalise/restore.h"
#include "nodes/normalise/style.h"
#include "nodes/normalise/zscore.h"

namespace talkgraph {

void register_normalise(Registry& registry) {
  registry.add<LearnIca>();
  registry.add<MeanCenter>();
  registry.add<MeanOf>();
  registry.add<RankStyle>();
  registry.add<RemoveStyle>();
  registry.add<Restore>();
  registry.add<ZscoreLearn>();
  registry.add<ZscoreApply>();
}

}  // namespace talkgraph
