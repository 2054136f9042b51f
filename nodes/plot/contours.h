#pragma once

#include <Eigen/Core>
#include <vector>

namespace talkgraph {

using Ring = std::vector<Eigen::Vector2d>;

/// Where a function on a grid is at least `level`: rings around that area, counter-clockwise, and clockwise around
/// holes in it, by marching squares with linear interpolation. values(r, c) stands at x = c, y = r; rings at the grid's
/// edge run along it. A saddle is decided by the mean of its corners. Values must not be NaN.
std::vector<Ring> rings_above(const Eigen::MatrixXd& values, double level);

}  // namespace talkgraph
