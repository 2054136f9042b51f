#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// One phone a frame of a track: the one that takes most of the frame's
/// interval, which is 1/rate long around the frame's centre; of equals, the
/// earlier one. Time not covered by any phone counts as "sil". docs/method.md §1.
struct LabelFrames {
  FrameLabels operator()(const PhoneTrack& phones, const Track& like) const;
};
void describe(Description<LabelFrames>& d);

}  // namespace talkgraph
