#pragma once

#include "graph/description.h"
#include "nodes/types/frames.h"

namespace talkgraph {

/// Takes each frame's mean off: HTK's ZMEANSOURCE, Kaldi's --remove-dc-offset.
struct RemoveMean {
  Frames operator()(const Frames& frames) const;
};
void describe(Description<RemoveMean>& d);

}  // namespace talkgraph
