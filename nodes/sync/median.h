#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// To the video rate by the median, per dimension, of the frames whose centres
/// lie in the video frame's interval, or of the nearest one where there is none.
/// The mean of the middle two where their number is even. Thesis §3.5.1.
struct MedianSync {
  Rational rate{25};

  Track operator()(const Track& track, const Audio* audio) const;
};
void describe(Description<MedianSync>& d);

}  // namespace talkgraph
