#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class EdgeBands { copied, added, kept };
template <>
inline constexpr EnumNames<EdgeBands, 3> enum_names<EdgeBands>{
    {{EdgeBands::copied, "copied"}, {EdgeBands::added, "added"}, {EdgeBands::kept, "kept"}}};

/// Perceptual linear prediction: the auditory spectrum of each frame, given by its logs in M bands (T × M), smoothed by
/// an all-pole model of it; that model's cepstrum, of whose `coefficients` the 0th, the log gain, is dropped (T ×
/// coefficients - 1).
///
/// The bands are points from 0 to π of an even spectrum, its inverse DFT is the autocorrelation. The points at 0 and π
/// say little where filters are centred there, as Bark filters are, and are missing where they are not, as mel filters
/// are: they are taken from their neighbours. Throws std::invalid_argument for an order that is not below the number of
/// points. Hermansky 1990; HTK Book; rastamat; thesis §3.2.5.
struct AllPole {
  EdgeBands edges = EdgeBands::copied;
  int order = 20;         ///< of the all-pole model
  int coefficients = 21;  ///< with the 0th
  bool keep_zeroth = false;
  double lifter = 0;           ///< HTK's L: c_n times 1 + L/2 sin(π n / L); 0: none
  double lifter_exponent = 0;  ///< rastamat's: c_n times n to this; 0: none

  Track operator()(const Track& track) const;
};
void describe(Description<AllPole>& d);

}  // namespace talkgraph
