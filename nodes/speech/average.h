#pragma once

#include <string>

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The mean over the dimensions, u_t = 1/D Σ_d y_{t,d} (T × 1). Thesis Eqn 6.10. Throws std::runtime_error where there
/// are no dimensions.
struct Average {
  std::string name = "mean";

  Track operator()(const Track& track) const;
};
void describe(Description<Average>& d);

}  // namespace talkgraph
