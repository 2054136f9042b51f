#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a plot as FOLDER/NAME.svg below the run folder; NAME is that of the
/// item unless it is given. Errors: the file cannot be written.
struct WritePlot {
  std::string name;
  std::string folder = "plots";

  Artifact operator()(const Plot& plot, Context& context) const;
};
void describe(Description<WritePlot>& d);

}  // namespace talkgraph
