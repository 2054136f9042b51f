#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Writes a track as FOLDER/ITEM.csv below the run folder, a line a frame, as a
/// manifest's `visual` reads it. Its dimensions are named as those of `named`,
/// if that has as many. Errors: the file cannot be written.
struct WriteTrack {
  std::string folder = "tracks";

  Artifact operator()(const Track& track, const Track* named, Context& context) const;
};
void describe(Description<WriteTrack>& d);

}  // namespace talkgraph
