#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nodes/types/sgpdm.h"

namespace talkgraph {

/// The process h of x_t = h(x_{t−1}) + noise over latent points that stay where they are (N × d, windows of the given
/// lengths one after the other): kernel RBF + linear + white, of which all but the RBF's inverse width is optimised;
/// FITC where there are more steps than inducing points. There must be a window of two frames. Throws
/// FactorisationError.
GaussianProcess fit_dynamics(const Eigen::MatrixXd& latents, const std::vector<std::int64_t>& lengths,
                             double inverse_width, int inducing, int iterations);

}  // namespace talkgraph
