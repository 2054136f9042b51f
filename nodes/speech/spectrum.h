#pragma once

#include "graph/description.h"
#include "nodes/speech/window.h"

namespace talkgraph {

enum class SpectrumKind { magnitude, power, periodogram };
template <>
inline constexpr EnumNames<SpectrumKind, 3> enum_names<SpectrumKind>{{{SpectrumKind::magnitude, "magnitude"},
                                                                      {SpectrumKind::power, "power"},
                                                                      {SpectrumKind::periodogram, "periodogram"}}};

/// Short-time spectrum: frames weighed with a window, as speech.window does but without a copy of them, padded with
/// zeros to the next power of two (or to `size`), DFT, bins 0 to Nyquist (T × size / 2 + 1): magnitude |DFT|, power
/// |DFT|², or periodogram |DFT|² / size.
struct ShortTimeSpectrum {
  Window window{WindowShape::rectangular};
  SpectrumKind kind = SpectrumKind::magnitude;
  int size = 0;  ///< points of the DFT, a power of two; 0: the next one

  Spectrum operator()(const Frames& frames) const;
};
void describe(Description<ShortTimeSpectrum>& d);

}  // namespace talkgraph
