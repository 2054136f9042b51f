#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Puts back what was taken off: the inverse of normalise.mean_center (one row
/// for all frames) and normalise.remove_style (a row a frame). Throws
/// std::runtime_error if dimensions differ, or if there are several rows and
/// more than two too few; then the last is held.
struct Restore {
  Track operator()(const Track& centred, const Track& mean) const;
};
void describe(Description<Restore>& d);

}  // namespace talkgraph
