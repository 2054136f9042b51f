#include "nodes/plot/register.h"

#include "nodes/plot/bars.h"
#include "nodes/plot/columns.h"
#include "nodes/plot/contexts.h"
#include "nodes/plot/convergence.h"
#include "nodes/plot/curves.h"
#include "nodes/plot/latent.h"
#include "nodes/plot/mean_trajectory.h"
#include "nodes/plot/phone_means.h"
#include "nodes/plot/tracks.h"
#include "nodes/plot/trajectories.h"

namespace talkgraph {

void register_plot(Registry& registry) {
  registry.add<MeanTrajectory>();
  registry.add<PhoneMeans>();
  registry.add<PlotBars>();
  registry.add<PlotColumns>();
  registry.add<PlotContexts>();
  registry.add<PlotConvergence>();
  registry.add<PlotCurves>();
  registry.add<PlotLatent>();
  registry.add<PlotTracks>();
  registry.add<PlotTrajectories>();
}

}  // namespace talkgraph
