#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Sound of line spectral frequencies: an excitation e through 1 / A(z), one normalised lattice that keeps its state
/// from frame to frame, its frequencies interpolated between frames and kept `spacing` rad apart. It stays bounded
/// whatever the track.
///
/// The excitation e has the power gain²: at a voicing v, pulses at f0 have the share v of it and white noise has 1 - v;
/// its mean is 0. Where no f0 is given, pulses come at `f0`; frames whose f0 is not above 0 are noise, and
/// hold the fundamental of the voiced frame before. Without a gain it is `level`. A given `excitation` is used as it is
/// and gives rate and length.
///
/// Tracks may differ in rate and length: each is read at its own times and held beyond its ends. The sound lasts as
/// long as the frames of `lsf`. It has the pre-emphasis of what was analysed: speech.deemphasis is next. Throws as
/// speech.from_lsf does, and on gains, f0 or voicing that are not finite. Thesis §5.5.
struct Resynthesise {
  double sample_rate = 16000;
  double f0 = 120;         ///< Hz; 0: noise
  double level = 0.01;     ///< full scale 1
  double step = 0.0025;    ///< seconds
  double spacing = 0.005;  ///< rad

  Audio operator()(const Track& lsf, const Track* gain, const Track* f0_track, const Audio* excitation,
                   Random& random) const;
};
void describe(Description<Resynthesise>& d);

}  // namespace talkgraph
