#pragma once

#include <Eigen/Core>
#include <cmath>

#include "nodes/latent/cholesky.h"

namespace talkgraph {

/// The cost of what is to be maximised, and its gradient: the negatives of value(), which sets `gradient` too. False
/// where it is not finite or throws FactorisationError.
template <class Value>
bool evaluate_negative(Value value, double& cost, Eigen::VectorXd* gradient) {
  try {
    cost = -value();
    if (gradient) *gradient = -*gradient;
    return std::isfinite(cost);
  } catch (const FactorisationError&) {
    return false;
  }
}

}  // namespace talkgraph
