#pragma once

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// One speaker of the GRID audio-visual sentence corpus: FOLDER/split.json names the clips
/// of each split; video/ID.mpg pictures and sound, align/ID.align word times,
/// landmarks/ID.csv 68 points a frame (the folder may be absent). Clips come in the order
/// of split.json. Throws std::runtime_error: everything that is missing, in one go, when
/// it starts; a malformed label or landmark file, with its line, when its clip's turn comes.
/// `lenient` leaves such files out instead, and tells of them in Recording::faults.
struct Grid {
  FilePath folder;
  int limit = 0;  ///< clips of each split, 0 for all
  bool lenient = false;

  Stream<Recording> operator()() const;
};
void describe(Description<Grid>& d);

}  // namespace talkgraph
