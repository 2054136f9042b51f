#pragma once

#include "nodes/types/gmm.h"

namespace talkgraph {

/// A hidden Markov model of K states, each with a mixture of Gaussians.
struct Hmm {
  Eigen::VectorXd start;                      ///< p(π_1), K
  Eigen::MatrixXd transitions;                ///< p(π_t = column | π_{t−1} = row), K × K
  std::vector<GaussianMixture> observations;  ///< one a state
  std::vector<double> trace;  ///< log-likelihood of the training sequences at the start and after each iteration

  Eigen::Index states() const { return start.size(); }
};
template <>
inline constexpr PortType port_type<Hmm>{"Hmm", 1};
void fields(Archive& ar, Hmm& h);

}  // namespace talkgraph
