#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Passes on a track that was computed at the video rate, on the frames of the video (`speech.frame`, centred). Has as
/// many frames as the other ways give: where resampled sound is a frame shorter or longer, the last one is repeated or
/// left out. Throws std::runtime_error where rate, first frame or length are others. Thesis §3.5.1.
struct DirectSync {
  Rational rate{25};

  Track operator()(const Track& track, const Audio* audio) const;
};
void describe(Description<DirectSync>& d);

}  // namespace talkgraph
