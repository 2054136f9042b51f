#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/value.h"
#include "nodes/types/phone_chain.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// A deterministic process dynamical system of K phones and D visual dimensions (Eqns 5.9-5.11), each dimension by
/// itself: x_1 = μ_π, x_t = A_π x_{t−1} + ν_π, z_t = x_t + w, w ~ N(0, Γ), of scaled frames.
struct Dpds {
  Scaling visual;
  PhoneChain chain;
  Eigen::MatrixXd first;       ///< μ, K × D
  Eigen::MatrixXd prediction;  ///< diagonals of A, K × D
  Eigen::MatrixXd offset;      ///< ν, K × D
  Eigen::RowVectorXd noise;    ///< diagonal of Γ, 1 × D
  std::vector<double> trace;   ///< log-likelihood of the training frames at the start and after each iteration
};
template <>
inline constexpr PortType port_type<Dpds>{"Dpds", 2};
void fields(Archive& ar, Dpds& d);

}  // namespace talkgraph
