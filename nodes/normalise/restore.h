#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Puts a mean back: the inverse of normalise.mean_center.
struct Restore {
  Track operator()(const Track& centred, const Track& mean) const;
};
void describe(Description<Restore>& d);

}  // namespace talkgraph
