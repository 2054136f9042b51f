#pragma once

#include "graph/description.h"
#include "nodes/types/curves.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Curves of the first sequences over time, those of all methods in one panel (thesis Figures 6.1 to 6.4).
/// Sequences that a method lacks are left out.
struct PlotTrajectories {
  int sequences = 3;
  std::string y_label = "mean";
  std::string title = "Mean trajectories";

  Plot operator()(const Collected<Curves>& curves) const;
};
void describe(Description<PlotTrajectories>& d);

}  // namespace talkgraph
