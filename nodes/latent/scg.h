#pragma once

#include "nodes/latent/optimiser.h"

namespace talkgraph {

/// Scaled conjugate gradients (Møller 1993): conjugate directions whose step
/// length comes from a finite difference of the gradient along them, scaled so
/// that the curvature is positive. No line search.
struct ScaledConjugateGradients : Optimiser {
  using Optimiser::minimise;
  void minimise(Objective& objective, OptimiserState& state) const override;
};

}  // namespace talkgraph
