#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// A linear predictor, x[t] ≈ Σ a_k x[t-k]: the inverse filter is A(z) = 1 - Σ a_k z^-k.
struct LinearPrediction {
  Eigen::VectorXd a;           ///< a_1 ... a_p
  Eigen::VectorXd reflection;  ///< k_1 ... k_p, k_m = a_m of the predictor of order m; each below 1 in size
  double error = 0;            ///< what is left of r_0: r_0 Π (1 - k_m²), the square of the gain
};

/// Predictor from the autocorrelations r_0 ... r_p by the Levinson-Durbin recursion. It is always stable: from the
/// order at which nothing is left to predict but rounding errors, or at which `r` is no autocorrelation any more (|k| ≥
/// 1), coefficients are 0. So all are for r_0 ≤ 0, as silence has. `out` is written over and its memory kept.
void levinson(const Eigen::Ref<const Eigen::VectorXd>& r, LinearPrediction& out);

/// The predictor of order m + 1 from that of order m in the head of `a`, with k_{m+1} = `k`.
void step_up(Eigen::VectorXd& a, Eigen::Index m, double k);

}  // namespace talkgraph
