#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Mean trajectories of all dimensions of tracks through phones, a line each with a band of ± a standard deviation:
/// each occurrence of a phone, with `margin` frames on both sides, stretched to unit length and averaged over all
/// sequences. Sequences without labels are left out; lengths may differ by two frames.
struct PhoneMeans {
  std::vector<std::string> phones = {};  ///< shown, a panel each; empty: the most frequent
  int most = 9;                          ///< of the most frequent ones, silence left out
  int margin = 2;                        ///< frames
  bool band = true;
  std::string title = "Mean trajectories through phones";

  Plot operator()(const Collected<Track>& tracks, const Collected<FrameLabels>& labels) const;
};
void describe(Description<PhoneMeans>& d);

}  // namespace talkgraph
