#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Mel cepstrum: DCT of log filter outputs, c_i = √(2/M) Σ_m log_m cos(π i (m - ½) / M),
/// in the HTK convention; of `coefficients` the 0th is dropped (T × coefficients - 1).
/// Thesis §3.2.
struct Cepstrum {
  int coefficients = 21;  ///< with the 0th
  bool keep_zeroth = false;
  bool orthonormal = false;  ///< c_0 by √(1/M)
  double lifter = 0;         ///< HTK's L: c_i times 1 + L/2 sin(π i / L); 0: none

  Track operator()(const Track& track) const;
};
void describe(Description<Cepstrum>& d);

/// HTK's weight of the cepstral coefficient n, 1 + L/2 sin(π n / L); 1 for L = 0.
double lifter_weight(int n, double length);

}  // namespace talkgraph
