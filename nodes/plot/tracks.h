#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The first dimensions of two tracks of a sequence over time.
struct PlotTracks {
  int dimensions = 3;

  Plot operator()(const Track& truth, const Track& predicted, Context& context) const;
};
void describe(Description<PlotTracks>& d);

}  // namespace talkgraph
