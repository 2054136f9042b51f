#pragma once

#include <string>

#include "nodes/types/shape.h"

namespace talkgraph {

/// Distance between two points in every frame, T values, nan where a frame has no landmarks; the points have these
/// names in the scheme. Throws std::runtime_error if the scheme is unknown or has no such point, or a frame has
/// another number of points.
Eigen::VectorXd point_distance(const LandmarkTrack& landmarks, const std::string& a, const std::string& b);

}  // namespace talkgraph
