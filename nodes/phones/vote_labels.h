#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Labels at another rate (phones at 100 Hz) brought to the frames of a track: the label that takes most of
/// a frame's interval, where label n lies around (n + ½) / labels.rate and reaches as far as its neighbours; of
/// equals, the earlier one. Time beyond the labels counts as "sil". docs/method.md §1.
struct VoteLabels {
  FrameLabels operator()(const FrameLabels& labels, const Track& like) const;
};
void describe(Description<VoteLabels>& d);

}  // namespace talkgraph
