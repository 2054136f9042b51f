#pragma once

#include "graph/description.h"
#include "nodes/context/segment.h"
#include "nodes/types/phones.h"
#include "nodes/types/segments.h"
#include "nodes/types/track.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// The training windows of each state, one item a state, keyed by its label:
/// every stretch of the training streams that equals the label's phones,
/// overlaps allowed; with phones as states, the runs of each phone; with one
/// state, whole utterances (docs/method.md §5).
/// A window with a lost visual frame is left out, an utterance is cut there; or,
/// with gaps, such frames stay as NaN.
/// States with most frames come first. A state has windows of at most
/// `max_frames` frames together, or one longer window; they are chosen evenly
/// from all.
///
/// Streams are paired by key; an utterance that one of the three lacks is left
/// out, and a state without a window gives no item. The stream refers to the
/// tracks given, which must outlive it. Throws std::runtime_error
/// if no utterance is left, or lengths differ by more than two frames.
struct ContextWindows {
  StateKind states = StateKind::contexts;
  int max_frames = 1000;
  bool gaps = false;

  Stream<StateData> operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels, const Collected<Track>& audio,
                               const Collected<Track>& visual) const;
};
void describe(Description<ContextWindows>& d);

}  // namespace talkgraph
