#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// y[t] = b0 x[t] + b1 x[t-1] + b2 x[t-2] - a1 y[t-1] - a2 y[t-2]
struct Biquad {
  double b0, b1, b2, a1, a2;

  /// Filters in place, begun as if the first sample had stood for ever; there must be one.
  void run(Eigen::Ref<Eigen::VectorXd> x) const;
};

/// A low-pass of order 2 by the bilinear transform: gain √½ at the cutoff, which is below half the rate.
Biquad butterworth(double cutoff, double rate);

}  // namespace talkgraph
