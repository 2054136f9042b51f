#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Mean trajectories through the most frequent phones, truth against
/// prediction: each occurrence of a phone, stretched to unit length with a
/// margin of `margin` frames on both sides, averaged over all sequences
/// (thesis Figures 3.9 to 3.16, 6.1 to 6.4).
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
