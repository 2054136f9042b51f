#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// To the video rate by a cosine-modulated (pseudo-quadrature mirror) filter bank of M critically sampled bands, M the
/// ratio of the rates: the lowest band alone, mapped back to the time domain and read at each video frame's centre.
///
/// Band k analyses with h_k(τ) = 2 p(τ) cos((2k + 1) π τ / 2M + (−1)^k π/4), τ in input frames from the video frame's
/// centre, and synthesises with h_k(−τ), which undoes its phase: there is no delay below the transition to the next
/// band, where critical sampling folds one into the other. p is a Kaiser-windowed sinc whose response at π/2M is 1/√2
/// of that at 0, so that all bands together nearly reconstruct the input (Cruz-Roldán et al. 2002). The weights are
/// normalised, so that a constant stays what it is. Ends are repeated.
///
/// Throws std::runtime_error unless the ratio is an integer of 2 or more. Thesis §3.5.1; Rothweiler 1983.
struct Quadrature {
  Rational rate{25};
  int length = 8;   ///< of the prototype on each side, video frames
  double beta = 9;  ///< of its Kaiser window

  Track operator()(const Track& track, const Audio* audio) const;
};
void describe(Description<Quadrature>& d);

}  // namespace talkgraph
