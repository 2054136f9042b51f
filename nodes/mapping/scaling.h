#pragma once

#include <utility>

#include "nodes/types/scaling.h"

namespace talkgraph {

/// Mean and standard deviation of every dimension of frames, N × D with N ≥ 1.
Scaling scaling_of(const Eigen::MatrixXd& frames);
/// That of the first `dims` dimensions, and that of the others.
std::pair<Scaling, Scaling> split(const Scaling& scaling, Eigen::Index dims);
/// Frames of mean 0 and deviation 1, or 0 where a dimension does not vary.
Eigen::MatrixXd scaled(const Scaling& scaling, const Eigen::MatrixXd& frames);
/// The frames that scaled() came from.
Eigen::MatrixXd restored(const Scaling& scaling, const Eigen::MatrixXd& frames);

}  // namespace talkgraph
