#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Trajectories averaged over all dimensions, u_t = 1/D Σ_d z_{t,d}, of the
/// first sequences: truth against prediction over time (thesis Eqns 6.10 and
/// 6.11, Figures 6.1 to 6.4). Sequences that one of the two lacks are left out.
struct PlotTrajectories {
  int sequences = 3;
  std::string title = "Mean trajectories";

  Plot operator()(const Collected<Track>& truth, const Collected<Track>& predicted) const;
};
void describe(Description<PlotTrajectories>& d);

}  // namespace talkgraph
