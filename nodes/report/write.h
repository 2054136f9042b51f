#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes report.html, one page with all tables, plots and clips, which needs
/// no other file than the clips and pictures it names, each plot as
/// plots/NAME.svg, and metrics.json with the numbers of all tables. Without any
/// of them it still writes a page. Errors: a file cannot be written.
struct WriteReport {
  std::string title = "talkgraph report";
  std::string notes;  ///< a paragraph under the title

  Artifact operator()(const Collected<Table>& tables, const Collected<Plot>& plots, const Collected<Artifact>& clips,
                      Context& context) const;
};
void describe(Description<WriteReport>& d);

}  // namespace talkgraph
