#pragma once

#include <Eigen/Core>

#include "nodes/latent/kernel.h"

namespace talkgraph {

/// Every number to `bits` binary places behind its first, 1 to 20: the fewer, the less room it takes in a file.
Eigen::MatrixXd rounded(const Eigen::MatrixXd& m, int bits);

/// The same process in fewer bytes: its root lower triangular, weights and root
/// rounded to 16 or 20 places, unless predictions at `x` would move by more than
/// a thousandth of their deviation, or their variances by more than a thousandth.
GaussianProcess compacted(GaussianProcess gp, const ConstMatrix& x);

}  // namespace talkgraph
