#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// The slope that Keogh & Pazzani (2001) compare: ((x_t − x_{t−1}) + (x_{t+1} − x_{t−1})/2) / 2 of all values but the
/// first and the last; none of fewer than three.
Eigen::VectorXd warping_slopes(const Eigen::VectorXd& x);

/// How far two movements differ in slope when each may wait for the other: root mean square difference of their slopes
/// along the warping path of the least sum of squares (Keogh & Pazzani 2001, who divide the root of the sum by the
/// path's length), which pairs frames at most `window` apart, or as far as the lengths differ. NaN of fewer than three
/// values.
double derivative_warping(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index window);

}  // namespace talkgraph
