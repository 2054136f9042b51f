#pragma once

#include "graph/description.h"
#include "nodes/types/frames.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class EqualLoudness { none, hermansky, hermansky_above_5khz, htk };
template <>
inline constexpr EnumNames<EqualLoudness, 4> enum_names<EqualLoudness>{
    {{EqualLoudness::none, "none"},
     {EqualLoudness::hermansky, "hermansky"},
     {EqualLoudness::hermansky_above_5khz, "hermansky_above_5khz"},
     {EqualLoudness::htk, "htk"}}};

/// ln of the equal loudness weight at `hz`, finite for all; at 0 Hz, where nothing is heard, that of the least number.
double log_equal_loudness(EqualLoudness curve, double hz, double nyquist);

/// From log filter outputs to log loudness, power · (x + ln E) (T × D), E the equal loudness weight at a filter's
/// centre.
///
/// Hermansky's, with ω = 2πf: E = (ω² + 56.8e6) ω⁴ / ((ω² + 6.3e6)² (ω² + 0.38e9)); above 5 kHz, where the sound has
/// that, with the factor 1 / (ω⁶ + 9.58e26). HTK's and rastamat's is the first, its constants rounded in Hz: E = (f² /
/// (f² + 1.6e5))² (f² + 1.44e6) / (f² + 9.61e6). Hermansky, Perceptual linear predictive (PLP) analysis of speech,
/// 1990; thesis §3.2.5, whose Eqn 3.33 is misprinted.
struct Loudness {
  EqualLoudness curve = EqualLoudness::hermansky;
  double power = 0.33;

  Track operator()(const Track& track, const Bands& bands) const;
};
void describe(Description<Loudness>& d);

}  // namespace talkgraph
