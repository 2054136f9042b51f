#pragma once

#include "nodes/speech/levinson.h"

namespace talkgraph {

/// Cepstrum c_0, c_1 ... of the all-pole spectrum error / |A|²: c_0 = ln error, c_n = a_n + Σ_k (1 - k / n) a_k
/// c_(n-k). `out` says how many; c_0 of silence, whose error is 0, is that of the least number.
void lp_cepstrum(const LinearPrediction& predictor, Eigen::Ref<Eigen::VectorXd> out);

}  // namespace talkgraph
