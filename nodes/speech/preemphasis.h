#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"

namespace talkgraph {

/// First-order pre-emphasis over the whole signal, x'[t] = x[t] - k x[t-1],
/// with x[-1] = x[0]. Thesis §3.2, Eqn 3.22.
struct PreEmphasis {
  double k = 0.97;

  Audio operator()(const Audio& audio) const;
};
void describe(Description<PreEmphasis>& d);

}  // namespace talkgraph
