#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"

namespace talkgraph {

/// Undoes pre-emphasis: x[t] = x'[t] + k x[t-1], after silence, x[-1] = 0.
struct Deemphasis {
  double k = 0.97;

  Audio operator()(const Audio& audio) const;
};
void describe(Description<Deemphasis>& d);

}  // namespace talkgraph
