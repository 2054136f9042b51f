#pragma once

#include "nodes/latent/optimiser.h"

namespace talkgraph {

/// Limited-memory BFGS (Nocedal 1980) with a backtracking line search to the
/// strong Wolfe conditions: libLBFGS.
struct Lbfgs : Optimiser {
  int memory = 10;  ///< steps that the inverse Hessian is approximated from

  using Optimiser::minimise;
  void minimise(Objective& objective, OptimiserState& state) const override;
};

}  // namespace talkgraph
