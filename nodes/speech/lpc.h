#pragma once

#include "graph/description.h"
#include "nodes/speech/levinson.h"
#include "nodes/speech/window.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class LpcMethod { autocorrelation, covariance, burg };
template <>
inline constexpr EnumNames<LpcMethod, 3> enum_names<LpcMethod>{{{LpcMethod::autocorrelation, "autocorrelation"},
                                                                {LpcMethod::covariance, "covariance"},
                                                                {LpcMethod::burg, "burg"}}};

struct LpcTracks {
  Track lpc;   ///< a_1 ... a_p
  Track gain;  ///< root mean square of the residual, full scale 1
};

/// Linear prediction of each frame, x[t] ≈ Σ a_k x[t-k], A(z) = 1 - Σ a_k z^-k (T × order).
///
/// autocorrelation: frames as if zero outside, Levinson-Durbin; A is of minimum phase. Wants a `window`.
/// covariance: least squares over the samples that have `order` before them. A may have roots outside the unit circle.
/// burg: the lattice whose forward and backward residuals are least; A is of minimum phase.
///
/// `ridge` adds so much white noise, as a share of the energy. Without it (0) the methods are the textbooks'. The order
/// ends early, the coefficients above are 0, where what is left to predict is rounding errors: in silence, constant
/// frames, and by the covariance method in pure tones and frames of fewer than 2 · order samples.
///
/// The gain is that of unweighed frames: the mean square of `window` is divided out. Thesis §3.2.
struct Lpc {
  Window window{WindowShape::rectangular};
  LpcMethod method = LpcMethod::autocorrelation;
  int order = 20;
  double ridge = 0;

  LpcTracks operator()(const Frames& frames) const;
};
void describe(Description<Lpc>& d);

/// What linear prediction keeps from frame to frame: its result, and its memory.
struct LpcStep {
  Eigen::VectorXd a;  ///< a_1 ... a_p
  double power = 0;   ///< mean square of the residual

  Eigen::VectorXd weights, weighed;
  LinearPrediction levinson;
  Eigen::VectorXd products, forward, backward;
  Eigen::MatrixXd factor;
};

/// The predictor of one frame.
void linear_prediction(const Lpc& how, const Eigen::Ref<const Eigen::VectorXd>& frame, LpcStep& step);

}  // namespace talkgraph
