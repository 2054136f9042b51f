#pragma once

#include "graph/description.h"
#include "nodes/speech/filter_bank.h"

namespace talkgraph {

/// Log critical-band filter bank (T × filters): centres evenly spaced in Bark, z = 6 asinh(f / 600), the first at
/// `low`, the last at `high`. A filter is 1 within half a Bark of its centre; below, it falls by 10 dB a Bark, above
/// by 25. The spectrum should be a power spectrum. Thesis §3.2.5; Hermansky 1990; rastamat.
struct Bark {
  int filters = 30;
  double low = 0;          ///< Hz
  double high = 0;         ///< Hz; 0: Nyquist
  double width = 1;        ///< of the skirts, times the above
  bool truncated = false;  ///< skirts end at -2.5 and 1.3 Bark
  double scale = 32768;    ///< full scale of the samples
  double floor = 1;        ///< least filter output before the log

  FilterOutputs operator()(const Spectrum& spectrum) const;

  /// Weights of the filters (bins × filters).
  Eigen::MatrixXd weights(Eigen::Index bins, double bin_hz) const;
  /// Centres of the filters, Hz.
  Eigen::VectorXd centres(double nyquist) const;
};
void describe(Description<Bark>& d);

}  // namespace talkgraph
