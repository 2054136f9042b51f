#pragma once

#include "nodes/types/frames.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What a filter bank gives.
struct FilterOutputs {
  Track track;  ///< logs of the filter outputs (T × filters)
  Bands bands;  ///< where the filters lie
};

/// ln max(floor, Σ_k w_k S_k) of each filter, a column of `weights` (bins × filters), over spectra of samples whose
/// full scale is `scale`.
Track log_outputs(const Spectrum& spectrum, const Eigen::MatrixXd& weights, double scale, double floor);

/// Where a filter bank from `low` Hz to `high` Hz ends; 0 stands for the Nyquist frequency. Throws
/// std::invalid_argument where it does not fit below that.
double bank_end(double low, double high, double nyquist);

}  // namespace talkgraph
