#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Each frame with its `before` predecessors and `after` successors, oldest
/// first (T × D (before + 1 + after)); the first and last frame are repeated
/// beyond the ends. A frame with a lost neighbour is lost; names say which neighbour they are of: "c1 at -2".
struct Stack {
  int before = 5;
  int after = 5;

  Track operator()(const Track& track) const;
};
void describe(Description<Stack>& d);

}  // namespace talkgraph
