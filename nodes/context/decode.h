#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// The context label of each frame of a phone stream: its memory and the phone,
/// joined by '-', oldest first (docs/method.md §5, thesis Figure 5.9). An unseen phone or
/// transition gives the phone alone. With a model of runs all frames of a run
/// carry the run's context. Throws std::runtime_error if a phone's name is
/// empty or holds '-'.
struct ContextDecode {
  FrameLabels operator()(const Vlmm& vlmm, const FrameLabels& labels) const;
};
void describe(Description<ContextDecode>& d);

}  // namespace talkgraph
