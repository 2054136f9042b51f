#pragma once

#include <Eigen/Core>
#include <vector>

#include "graph/value.h"
#include "nodes/types/shape.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Similarity transform from the model's frame to the picture:
/// (x, y) -> scale · R(angle) · (x, y) + (dx, dy).
struct Pose {
  double scale = 1, angle = 0, dx = 0, dy = 0;
};
template <>
inline constexpr bool is_row<Pose> = true;
void fields(Archive& ar, Pose& p);

/// An appearance model followed through a clip; vectors have one entry a frame.
struct FaceTrack {
  Track parameters;  ///< combined appearance parameters c, T × modes
  std::vector<Pose> poses;
  std::vector<double> gain, offset;  ///< of the texture, photometric
  std::vector<double> residual;      ///< RMS texture error of the fit, grey levels
  std::vector<double> confidence;    ///< 0 (lost) to 1: distance to the nearest bound of a good fit
  std::vector<std::int64_t> lost;    ///< 1 where the fit is not to be trusted (damaged picture, drift)
  std::vector<Shape> shapes;         ///< fitted landmarks in the picture
};
template <>
inline constexpr PortType port_type<FaceTrack>{"FaceTrack", 2};
void fields(Archive& ar, FaceTrack& f);

}  // namespace talkgraph
