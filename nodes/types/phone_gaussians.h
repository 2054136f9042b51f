#pragma once

#include <string>
#include <vector>

#include "graph/value.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// A Gaussian of scaled visual parameters a phone, and how trajectories go through them (Ezzat, Geiger and Poggio
/// 2002).
struct PhoneGaussians {
  std::vector<std::string> phones;
  Eigen::MatrixXd means;      ///< a row a phone, and a last one for phones that training had none of
  Eigen::MatrixXd variances;  ///< likewise
  double smoothness = 0;      ///< λ of Eqn 4.8
  std::int64_t order = 0;     ///< of the differences that are kept small
  Scaling scaling;            ///< of the visual parameters
  std::vector<double> trace;  ///< mean squared error of training trajectories at the start and after each iteration
};
template <>
inline constexpr PortType port_type<PhoneGaussians>{"PhoneGaussians", 1};
void fields(Archive& ar, PhoneGaussians& g);

}  // namespace talkgraph
