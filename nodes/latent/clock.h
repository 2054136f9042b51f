#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nodes/types/sgpdm.h"

namespace talkgraph {

/// What dynamics of time or phase take: when each frame of windows of these lengths is, N × 1.
Eigen::MatrixXd times_of(const std::vector<std::int64_t>& lengths, DynamicsForm form);

/// Inducing points for such dynamics to start from, at even distances over all times: one a half length scale of an RBF
/// kernel of that inverse width, at most `most`, m × 1.
Eigen::MatrixXd spread_times(const Eigen::MatrixXd& times, double inverse_width, Eigen::Index most);

}  // namespace talkgraph
