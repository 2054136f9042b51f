#pragma once

#include "nodes/types/sgpdm.h"

namespace talkgraph {

/// A Gaussian process dynamical model of one stream; without dynamics, a GPLVM.
struct Gpdm {
  Eigen::MatrixXd latents;                  ///< N × d, sequences one after the other
  std::vector<std::int64_t> lengths;        ///< of the sequences; they sum to N
  std::vector<std::string> names;           ///< of the observed dimensions; may be empty
  GaussianProcess observations;             ///< f: X -> Y
  std::optional<GaussianProcess> dynamics;  ///< h: x_{t−1} -> x_t, or its difference from x_{t−1}
  DynamicsForm form = DynamicsForm::absolute;
  std::optional<BackConstraint> back_constraint;  ///< b: Y -> X, of scaled frames
  double dynamics_bias = 1;                       ///< weight of the dynamics
  double first_variance = 1;                      ///< of the prior of first points
  double log_likelihood = 0;                      ///< training objective reached, natural logarithm
  double jitter = 0;                              ///< largest share of the mean variance added to a factorised matrix
  std::vector<double> trace;                      ///< the objective at the start and after each iteration
  std::string ended;                              ///< why training stopped: "converged", "iteration limit" ...
};
template <>
inline constexpr PortType port_type<Gpdm>{"Gpdm", 2};
void fields(Archive& ar, Gpdm& g);

}  // namespace talkgraph
