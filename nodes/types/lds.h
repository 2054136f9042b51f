#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A linear dynamical system of d state dimensions and D observed ones (Eqns 4.13-4.18):
/// x_1 ~ N(μ, Λ), x_t = A x_{t−1} + ν + v, v ~ N(0, Σ), y_t = mean + B x_t + w, w ~ N(0, Γ).
struct Lds {
  Eigen::VectorXd first_mean;         ///< μ, d
  Eigen::MatrixXd first_covariance;   ///< Λ, d × d
  Eigen::MatrixXd prediction;         ///< A, d × d
  Eigen::VectorXd offset;             ///< ν, d
  Eigen::MatrixXd prediction_noise;   ///< Σ, d × d
  Eigen::RowVectorXd mean;            ///< of the observations, 1 × D
  Eigen::MatrixXd observation;        ///< B, D × d
  Eigen::MatrixXd observation_noise;  ///< Γ, D × D, or D × 1 if it is diagonal
  std::vector<double> trace;  ///< log-likelihood of the training sequences at the start and after each iteration

  Eigen::Index states() const { return prediction.rows(); }
  Eigen::Index dimension() const { return mean.size(); }
};
template <>
inline constexpr PortType port_type<Lds>{"Lds", 1};
void fields(Archive& ar, Lds& l);

}  // namespace talkgraph
