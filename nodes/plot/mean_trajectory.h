#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Mean trajectories through the most frequent phones, truth against
/// prediction: each occurrence of a phone, with `margin` frames on both sides,
/// stretched to unit length and averaged over all sequences. Sequences that
/// one input lacks are left out; lengths may differ by two frames.
struct MeanTrajectory {
  int dimension = 0;  ///< of the tracks, from 0
  int phones = 9;     ///< most frequent ones, silence left out
  int margin = 2;     ///< frames
  std::string title = "Mean trajectories";

  Plot operator()(const Collected<Track>& truth, const Collected<Track>& predicted,
                  const Collected<FrameLabels>& labels) const;
};
void describe(Description<MeanTrajectory>& d);

}  // namespace talkgraph
