#pragma once

#include "nodes/face/sampling.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"

namespace talkgraph {

/// A place of the model in a picture, and how well it fits.
struct Fit {
  Eigen::VectorXd c;
  Pose pose;
  double gain = 0, offset = 0;  ///< photometric: picture = gain · texture + offset
  double error = 1;             ///< share of the texture's variance left unexplained, 0..1
  double residual = 0;          ///< RMS texture error, grey levels
  double detail = 0;            ///< correlation with the model once each colour's mean is gone: 0 on plain skin colour
};

/// Pose of small changes (a, b, x, y) in the model frame: [1+a, -b; b, 1+a], then the shift.
Pose small_pose(const Eigen::Vector4d& q);

/// Texture error of a fit at one level: fills gain, offset, error and residual, and
/// gives the normalised difference picture minus model.
void evaluate(const AppearanceModel& model, Pyramid& pyramid, std::size_t level, Fit& fit, Eigen::VectorXf& difference);

/// Fixed-Jacobian fit at one level (Algorithm 1): δ = -R δg, steps 1, 1.5, 0.5, 0.25; it ends
/// when no step lowers the error or the gain is below `tolerance` (relative).
/// Parameters are kept within `limit` standard deviations.
struct FitOptions {
  int iterations = 10;
  double tolerance = 1e-3;
  double limit = 4;
};
Fit fit(const AppearanceModel& model, Pyramid& pyramid, std::size_t level, const Fit& start, const FitOptions& options);

}  // namespace talkgraph
