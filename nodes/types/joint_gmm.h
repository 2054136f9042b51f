#pragma once

#include "nodes/types/gmm.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// A mixture of M Gaussians over audio and visual frames with their slopes, as converting sound to a face needs it:
/// x = [audio, slopes], y = [visual, slopes], all scaled; y | x, m ~ N(R_m x + mean_m, diag(variance_m)).
struct JointGmm {
  Scaling audio, visual;                     ///< of frames
  GaussianMixture sound;                     ///< of x
  std::vector<Eigen::MatrixXd> regressions;  ///< R, M of 2 D_Z × 2 D_Y
  Eigen::MatrixXd means;                     ///< M × 2 D_Z
  Eigen::MatrixXd variances;                 ///< M × 2 D_Z
  std::vector<double> trace;   ///< log-likelihood of the training frames at the start and after each iteration
  std::vector<double> errors;  ///< mean squared error of training trajectories, of the descent likewise
};
template <>
inline constexpr PortType port_type<JointGmm>{"JointGmm", 1};
void fields(Archive& ar, JointGmm& g);

}  // namespace talkgraph
