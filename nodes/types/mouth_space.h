#pragma once

#include <string>
#include <vector>

#include "nodes/types/shape.h"

namespace talkgraph {

/// How mouths are measured free of head pose: points that speech hardly moves are laid upon their training mean, and
/// what the mouth then does about its mean is told by its principal components.
struct MouthSpace {
  std::vector<std::string> reference;  ///< groups or points of the scheme that hold still
  std::vector<std::string> mouth;      ///< groups or points that are measured
  Shape mean;                          ///< of the points of `reference`, pixels
  Eigen::MatrixXd modes;               ///< 2m × k, unit columns; rows x, y of the points of `mouth`
};
template <>
inline constexpr PortType port_type<MouthSpace>{"MouthSpace", 1};
void fields(Archive& ar, MouthSpace& m);

}  // namespace talkgraph
