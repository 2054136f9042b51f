#pragma once

#include <Eigen/Core>

#include "graph/random.h"

namespace talkgraph {

/// Which cluster each row is in, N × K of 0 and 1: Lloyd's algorithm from rows chosen by k-means++ (Arthur and
/// Vassilvitskii 2007), the tightest of `starts`. No cluster is empty; there are fewer than `clusters` if there are
/// fewer distinct rows.
Eigen::MatrixXd k_means(const Eigen::MatrixXd& rows, Eigen::Index clusters, Random& random, int starts = 10);

}  // namespace talkgraph
