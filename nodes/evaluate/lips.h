#pragma once

#include "nodes/types/shape.h"

namespace talkgraph {

/// Distance between two points in every frame, T values. Throws
/// std::runtime_error on a frame whose shape lacks one of them.
Eigen::VectorXd point_distance(const LandmarkTrack& landmarks, int a, int b);

}  // namespace talkgraph
