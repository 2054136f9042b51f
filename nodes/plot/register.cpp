#include "nodes/plot/register.h"

#include "nodes/plot/mean_trajectory.h"
#include "nodes/plot/tracks.h"

namespace talkgraph {

void register_plot(Registry& registry) {
  registry.add<MeanTrajectory>();
  registry.add<PlotTracks>();
}

}  // namespace talkgraph
