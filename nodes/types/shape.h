#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// Landmark points, one row (x, y) each, in pixels: the centre of the top left
/// pixel is (0, 0), y grows downwards.
using Shape = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Landmarks of every frame of a clip, all of one point count; a frame without landmarks has points that are nan.
struct LandmarkTrack {
  std::vector<Shape> frames;
  Rational rate{25};
  std::string scheme;  ///< name of a built-in point scheme, or the text of another (nodes/types/scheme.h); may be empty
};
template <>
inline constexpr PortType port_type<LandmarkTrack>{"LandmarkTrack", 1};
void fields(Archive& ar, LandmarkTrack& l);

}  // namespace talkgraph
