#pragma once

#include <string>

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The dimensions of a track over time, a line each, in one panel. Thesis Figures 3.9 to 3.16.
struct PlotColumns {
  std::string title = "Trajectories";

  Plot operator()(const Track& track, Context& context) const;
};
void describe(Description<PlotColumns>& d);

/// As the track has it, or its number from 1.
std::string column_name(const Track& track, Eigen::Index d);

}  // namespace talkgraph
