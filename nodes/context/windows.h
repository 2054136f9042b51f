#pragma once

#include "graph/description.h"
#include "nodes/context/segment.h"
#include "nodes/types/phones.h"
#include "nodes/types/segments.h"
#include "nodes/types/track.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// The training windows of each state, one item a state: every stretch of the
/// training streams that equals the label's phones, overlaps allowed; with
/// phones as states, the runs of the phone. States with the most frames come
/// first. Streams are paired by key; what one of the three lacks is left out.
struct ContextWindows {
  StateKind states = StateKind::contexts;
  int max_frames = 1000;  ///< of a state; windows are thinned out evenly

  Stream<StateData> operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels, const Collected<Track>& audio,
                               const Collected<Track>& visual) const;
};
void describe(Description<ContextWindows>& d);

}  // namespace talkgraph
