#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What linear prediction leaves of sound, x[t] - Σ a_k x[t-k] where A(z) does not change, by a normalised lattice
/// whose line spectral frequencies are interpolated along the track. speech.resynthesise with the same track, `step`
/// and `spacing` makes the sound of it again, to rounding errors. The sound is the one that was framed: with
/// pre-emphasis, if the frames had it. Throws as speech.from_lsf does.
struct Residual {
  double step = 0.0025;    ///< seconds
  double spacing = 0.005;  ///< rad

  Audio operator()(const Audio& audio, const Track& lsf) const;
};
void describe(Description<Residual>& d);

}  // namespace talkgraph
