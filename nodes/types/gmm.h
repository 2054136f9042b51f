#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// Σ_k weight_k N(y | mean_k, Σ_k) of M components over D dimensions.
struct GaussianMixture {
  Eigen::VectorXd weights;                   ///< M, they sum to 1
  Eigen::MatrixXd means;                     ///< M × D
  std::vector<Eigen::MatrixXd> covariances;  ///< M of D × D, or of D × 1 if they are diagonal

  Eigen::Index components() const { return means.rows(); }
  Eigen::Index dimension() const { return means.cols(); }
};
void fields(Archive& ar, GaussianMixture& m);

/// A trained Gaussian mixture model.
struct Gmm {
  GaussianMixture mixture;
  std::vector<double> trace;  ///< log-likelihood of the training frames at the start and after each iteration
};
template <>
inline constexpr PortType port_type<Gmm>{"Gmm", 1};
void fields(Archive& ar, Gmm& g);

}  // namespace talkgraph
