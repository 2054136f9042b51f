#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/frames.h"

namespace talkgraph {

enum class BeforeFirst { zero, repeat };
template <>
inline constexpr EnumNames<BeforeFirst, 2> enum_names<BeforeFirst>{
    {{BeforeFirst::zero, "zero"}, {BeforeFirst::repeat, "repeat"}}};

/// First-order pre-emphasis over the whole signal, x'[t] = x[t] - k x[t-1]: a filter at rest before the sound begins,
/// so x'[0] = x[0], as scipy's lfilter and python_speech_features have it; or x[-1] = x[0], so that the offset of a
/// recording makes no click, x'[0] = (1 - k) x[0]. Thesis §3.2, Eqn 3.22.
struct PreEmphasis {
  double k = 0.97;
  BeforeFirst before = BeforeFirst::zero;

  Audio operator()(const Audio& audio) const;
};
void describe(Description<PreEmphasis>& d);

/// The same inside each frame, x'[0] = (1 - k) x[0], as HTK and Kaldi do (T × N).
struct FramePreEmphasis {
  double k = 0.97;

  Frames operator()(const Frames& frames) const;
};
void describe(Description<FramePreEmphasis>& d);

}  // namespace talkgraph
