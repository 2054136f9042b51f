#pragma once

#include <Eigen/Core>

#include "nodes/latent/kernel.h"

namespace talkgraph {

/// Every number to 21 significant bits, half a part in a million: what is
/// rounded so takes three bytes in a file.
Eigen::MatrixXd rounded(const Eigen::MatrixXd& m);

/// The same process in fewer bytes: its root lower triangular, weights and root
/// rounded, unless predictions at `x` would move by more than a thousandth of
/// their deviation, or their variances by more than a thousandth.
GaussianProcess compacted(GaussianProcess gp, const ConstMatrix& x);

}  // namespace talkgraph
