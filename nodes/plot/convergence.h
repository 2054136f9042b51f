#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// How training lowered its cost, −ln p, from iteration to iteration, and why it stopped. Up to `panels` models get a
/// panel each; of a switching model with more states one panel shows the median state, the band of the middle
/// 80 % and the `worst` states, those of the highest cost a frame at the end. A state that has stopped counts on with
/// its last value. Throws std::runtime_error on what is no trained model, or where no state has kept its costs.
struct PlotConvergence {
  struct Out {
    Plot plot;
    Table table;  ///< a row a reason to stop: states, iterations and frames of a state, on average
  };
  bool per_frame = true;  ///< the cost is divided by the frames trained on
  int panels = 6;
  int worst = 3;
  std::string title = "Convergence";

  Out operator()(const Value& model) const;
};
void describe(Description<PlotConvergence>& d);

}  // namespace talkgraph
