#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/frames.h"

namespace talkgraph {

/// Cuts sound into `rate` frames a second of `window` seconds each. A frame
/// begins at the sample nearest to its exact place, so hops of a fractional
/// number of samples do not drift.
///
/// Frame t covers t / rate to t / rate + window. Only whole frames are cut, but
/// at least one: sound shorter than a window is padded with zeros. Or, `centred`,
/// frame t lies around (t + ½) / rate, as video frames do; there are
/// seconds · rate of them, rounded up, at least 1, with zeros beyond the ends.
///
/// Throws std::runtime_error on NaN or infinite samples, std::invalid_argument
/// where window or hop is shorter than a sample. Thesis §3.2, §3.5.1.
struct Frame {
  double window = 0.025;  ///< seconds
  Rational rate{100};     ///< frames per second
  bool centred = false;   ///< on the grid of a video of this rate

  Frames operator()(const Audio& audio) const;
};
void describe(Description<Frame>& d);

}  // namespace talkgraph
