#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Low-pass of a track as it comes: a Butterworth filter of order 2 run forwards, begun as if the first frame had stood
/// for ever, read `delay` frames late. That takes back its lag on slow movement, √2/(2 tan(π · cutoff/rate)) frames:
/// one at 4.9 Hz and 25 frames a second. Frame t depends on no frame after t + delay; past its end the track stands
/// still. A cutoff at or above half the rate does nothing, at once.
///
/// `latency` gets the delay added, where it is wired. Throws std::runtime_error on values that are not finite.
struct LowpassOnline {
  struct Out {
    Track track;
    Scores latency;  ///< ms: "latency" and "latency_most"
  };
  double cutoff = 6;
  int delay = 1;

  Out operator()(const Track& track, const Scores* latency) const;
};
void describe(Description<LowpassOnline>& d);

}  // namespace talkgraph
