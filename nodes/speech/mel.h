#pragma once

#include "graph/description.h"
#include "nodes/types/frames.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Log mel filter bank in the HTK convention: mel = 1127 ln(1 + f / 700),
/// edges evenly spaced in mel from `low` to `high`, triangles linear in mel,
/// spectrum scaled to 16-bit samples, sums floored, natural log (T × filters).
struct Mel {
  int filters = 30;
  double low = 0;        ///< Hz
  double high = 0;       ///< Hz; 0: Nyquist
  double scale = 32768;  ///< full scale of the samples
  double floor = 1;      ///< least filter output before the log

  Track operator()(const Spectrum& spectrum) const;

  /// Weights of the filters (bins × filters).
  Eigen::MatrixXd weights(Eigen::Index bins, double bin_hz) const;
};
void describe(Description<Mel>& d);

}  // namespace talkgraph
