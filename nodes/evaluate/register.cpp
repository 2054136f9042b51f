#include "nodes/evaluate/register.h"

#include "nodes/evaluate/alignment.h"
#include "nodes/evaluate/columns.h"
#include "nodes/evaluate/compare.h"
#include "nodes/evaluate/curves.h"
#include "nodes/evaluate/dimensions.h"
#include "nodes/evaluate/explained.h"
#include "nodes/evaluate/join.h"
#include "nodes/evaluate/lip_movement.h"
#include "nodes/evaluate/lip_reader.h"
#include "nodes/evaluate/lip_reading.h"
#include "nodes/evaluate/mouth_lag.h"
#include "nodes/evaluate/mouth_opening.h"
#include "nodes/evaluate/pictures.h"
#include "nodes/evaluate/score.h"
#include "nodes/evaluate/seams.h"
#include "nodes/evaluate/sequences.h"
#include "nodes/evaluate/summary.h"
#include "nodes/evaluate/tracking.h"

namespace talkgraph {

void register_evaluate(Registry& registry) {
  registry.add<Compare>();
  registry.add<ComparePictures>();
  registry.add<Explained>();
  registry.add<JoinScores>();
  registry.add<LipMovement>();
  registry.add<MouthLag>();
  registry.add<MouthOpening>();
  registry.add<PickColumns>();
  registry.add<Score>();
  registry.add<ScoreAlignment>();
  registry.add<ScoreDimensions>();
  registry.add<ScoreLipReading>();
  registry.add<ScoreTracking>();
  registry.add<Seams>();
  registry.add<SequenceTable>();
  registry.add<Summary>();
  registry.add<TakeCurves>();
  registry.add<TrainLipReader>();
}

}  // namespace talkgraph
