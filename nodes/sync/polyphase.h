#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// To the video rate by anti-aliased resampling at the exact ratio: a
/// Kaiser-windowed sinc centred on each video frame, its weights normalised, so
/// that there is no delay and a constant stays what it is. Ends are repeated.
/// Thesis §3.5.1.
struct Polyphase {
  Rational rate{25};
  int zeros = 8;    ///< zero crossings of the sinc on each side
  double beta = 6;  ///< of the Kaiser window

  Track operator()(const Track& track, const Audio* audio) const;
};
void describe(Description<Polyphase>& d);

}  // namespace talkgraph
