#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Pauses before the first and after the last phone of an utterance get labels
/// of their own, "lead_sil", "trail_breath" ..., so that models of their own can
/// be learnt for them (docs/method.md §5, thesis §5.4.4). An utterance without a phone is one
/// leading pause.
///
/// With `wait` the stream is marked as it is heard: a label depends on none that comes later. A pause after speech is
/// then trailing once it has lasted that long, whether or not speech comes again.
struct MarkPauses {
  double wait = 0;

  FrameLabels operator()(const FrameLabels& labels) const;
};
void describe(Description<MarkPauses>& d);

}  // namespace talkgraph
