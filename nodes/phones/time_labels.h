#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Phones with their times from one label a frame, label n from n / rate to (n + 1) / rate: each run of equal labels is
/// one phone, so two of the same phone in succession are one. No labels give no phones. phones.label_frames gives the
/// labels back.
struct TimeLabels {
  PhoneTrack operator()(const FrameLabels& labels) const;
};
void describe(Description<TimeLabels>& d);

}  // namespace talkgraph
