#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/frames.h"

namespace talkgraph {

/// Cuts sound into `rate` frames a second of `window` seconds each. Frame t
/// begins at the sample nearest to t / rate, so fractional hops do not drift;
/// its centre lies at window / 2 + t / rate. Only whole frames are cut,
/// but at least one: sound shorter than a window is padded with zeros.
/// Thesis §3.2.
struct Frame {
  double window = 0.025;  ///< seconds
  Rational rate{100};     ///< frames per second

  Frames operator()(const Audio& audio) const;
};
void describe(Description<Frame>& d);

}  // namespace talkgraph
