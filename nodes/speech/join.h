#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Two tracks side by side (T × D_a + D_b), or `a` alone where there is no `b`. They must
/// share rate and start and may differ by two frames in length.
struct Join {
  Track operator()(const Track& a, const Track* b) const;
};
void describe(Description<Join>& d);

}  // namespace talkgraph
