#pragma once

#include <functional>
#include <string>

#include "nodes/latent/objective.h"

namespace talkgraph {

enum class StopReason {
  converged,   ///< step and decrease both below their tolerances
  flat,        ///< the gradient vanished
  iterations,  ///< the iteration limit
  stalled,     ///< no step lowers the cost any more
  failed       ///< the cost could not be evaluated at the start
};
std::string str(StopReason reason);

/// How an optimisation went.
struct OptimiserReport {
  StopReason reason = StopReason::failed;
  int iterations = 0;
  int evaluations = 0;  ///< of cost and gradient together
  double cost = 0;      ///< reached
};

/// Scaled conjugate gradients (Møller 1993): conjugate directions whose step
/// length comes from a finite difference of the gradient along them, scaled so
/// that the curvature is positive. No line search.
struct ScaledConjugateGradients {
  int iterations = 100;
  double step_tolerance = 1e-4;  ///< largest change of a parameter
  double cost_tolerance = 1e-4;  ///< decrease of the cost
  std::function<void(int iteration, double cost)> on_iteration;

  /// Lowers the cost from `parameters`, which receive the best point found.
  OptimiserReport minimise(Objective& objective, Eigen::VectorXd& parameters) const;
};

}  // namespace talkgraph
