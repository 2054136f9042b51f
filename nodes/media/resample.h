#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"

namespace talkgraph {

/// Converts sound to another sample rate by libsoxr (HQ), band-limited, without
/// delay; the length becomes round(n · rate / audio.rate). No sound gives no sound.
struct Resample {
  double rate = 16000;  ///< samples per second

  Audio operator()(const Audio& audio) const;
};
void describe(Description<Resample>& d);

}  // namespace talkgraph
