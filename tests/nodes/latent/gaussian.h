#pragma once

#include <Eigen/Core>

#include "graph/random.h"

namespace talkgraph::testing {

inline Eigen::MatrixXd gaussian(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

}  // namespace talkgraph::testing
