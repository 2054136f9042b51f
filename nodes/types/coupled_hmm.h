#pragma once

#include "nodes/types/gmm.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// One of two chains that follow each other. Pairs of states (i of sound, j of face) are rows i + K_Y j.
struct CoupledChain {
  Eigen::VectorXd start;                      ///< p(π_1), K
  Eigen::MatrixXd transitions;                ///< p(π_t = column | both states of t − 1 = row), K_Y K_Z × K
  std::vector<GaussianMixture> observations;  ///< one a state

  Eigen::Index states() const { return start.size(); }
};
void fields(Archive& ar, CoupledChain& c);

/// A coupled hidden Markov model of sound and face.
struct CoupledHmm {
  Scaling audio_scaling;   ///< of audio frames beside their changes over time
  Scaling visual_scaling;  ///< of visual frames
  int changes = 0;         ///< 1: velocities of the sound are beside its frames; 2: accelerations too
  CoupledChain audio;
  CoupledChain visual;
  std::vector<double> trace;  ///< log-posterior of the training sequences at the start and after each iteration
};
template <>
inline constexpr PortType port_type<CoupledHmm>{"CoupledHmm", 1};
void fields(Archive& ar, CoupledHmm& c);

}  // namespace talkgraph
