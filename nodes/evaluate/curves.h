#pragma once

#include "graph/description.h"
#include "nodes/types/curves.h"

namespace talkgraph {

/// Of each track one curve over time, to be drawn: a dimension, or the average over all,
///   u_t = 1/D Σ_d z_{t,d} (thesis Eqns 6.10 and 6.11).
/// Throws std::runtime_error if a track lacks the dimension or has none.
struct TakeCurves {
  int dimension = -1;

  Curves operator()(const Collected<Track>& tracks) const;
};
void describe(Description<TakeCurves>& d);

}  // namespace talkgraph
