#pragma once

#include "graph/description.h"
#include "nodes/context/segment.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Cuts a stream of context labels into segments as it is heard, where context.segment begins at its end. From a
/// segment's first frame on, a frame joins as long as its context still has a trainable label of all phones since then
/// (runs, with a model of runs or phones as states); the segment is cut before the first frame that has none, or where
/// it reaches `lookahead`. So what a frame's segment is depends on no context later than `lookahead` after the frame.
/// Labels come forwards too, by context.decode; pauses at ends must be marked with `wait` of phones.mark_pauses.
///
/// Segments cover every frame. `latency` is what frames wait for their segment to be cut, ms: "latency", the mean,
/// and "latency_most"; both 0 without frames.
struct ContextSegmentOnline {
  struct Out {
    SegmentTrack segments;
    Scores latency;
  };
  StateKind states = StateKind::contexts;
  double lookahead = 200;

  Out operator()(const Vlmm& vlmm, const FrameLabels& contexts) const;
};
void describe(Description<ContextSegmentOnline>& d);

}  // namespace talkgraph
