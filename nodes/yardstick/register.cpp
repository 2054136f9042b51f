#include "nodes/yardstick/register.h"

#include "nodes/yardstick/mean.h"
#include "nodes/yardstick/neighbours.h"
#include "nodes/yardstick/ridge.h"
#include "nodes/yardstick/trajectories.h"

namespace talkgraph {

void register_yardstick(Registry& registry) {
  registry.add<MeanPredict>();
  registry.add<MeanTrain>();
  registry.add<NeighboursPredict>();
  registry.add<NeighboursTrain>();
  registry.add<RidgePredict>();
  registry.add<RidgeTrain>();
  registry.add<TrajectoriesPredict>();
  registry.add<TrajectoriesTrain>();
}

}  // namespace talkgraph
