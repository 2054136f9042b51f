#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/frames.h"

namespace talkgraph {

enum class FrameEnds { whole, zeros, mirror };
template <>
inline constexpr EnumNames<FrameEnds, 3> enum_names<FrameEnds>{
    {{FrameEnds::whole, "whole"}, {FrameEnds::zeros, "zeros"}, {FrameEnds::mirror, "mirror"}}};

/// Cuts sound into `rate` frames a second of `window` seconds each. A frame begins at the sample nearest to its exact
/// place, so hops of a fractional number of samples do not drift. There is always at least one frame.
///
/// Frame t covers t / rate to t / rate + window. Either only whole frames are cut (HTK; Kaldi's --snip-edges), or as
/// many as it takes to cover the sound, the last filled up with zeros (python_speech_features) or with the sound
/// mirrored at its end.
///
/// Or, `centred`, frame t lies around (t + ½) / rate, as video frames do; there are seconds · rate of them, rounded up.
/// Mirrored at both ends they are Kaldi's --snip-edges=false, which may have one less. Whatever `ends` says, what must
/// be filled up is: with zeros, unless with the sound mirrored.
///
/// Throws std::runtime_error on NaN or infinite samples and on those above 1e100, whose squares overflow,
/// std::invalid_argument where window or hop is shorter than a sample. Thesis §3.2, §3.5.1.
struct Frame {
  double window = 0.025;  ///< seconds
  Rational rate{100};     ///< frames per second
  bool centred = false;   ///< on the grid of a video of this rate
  FrameEnds ends = FrameEnds::whole;

  Frames operator()(const Audio& audio) const;
};
void describe(Description<Frame>& d);

}  // namespace talkgraph
