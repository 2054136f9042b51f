#pragma once

#include <Eigen/Core>

#include "graph/random.h"

namespace talkgraph {

/// How components are kept from being found twice: all at once, or one after
/// the other, each orthogonal to those before.
enum class Decorrelation { symmetric, deflation };

/// What non-Gaussianity is measured by (Eqns A.10, A.15): G₁ = (1/a₁) log cosh a₁u, g₁ = tanh a₁u,
/// or G₂ = −exp(−u²/2), g₂ = u exp(−u²/2).
enum class Contrast { logcosh, gauss };

/// FastICA (Hyvärinen 1999; thesis Appendix A).
struct FastIca {
  Decorrelation decorrelation = Decorrelation::symmetric;
  Contrast contrast = Contrast::logcosh;
  double a1 = 1;            ///< of logcosh, 1 to 2
  int iterations = 500;     ///< at most, for each component or for all at once
  double tolerance = 1e-6;  ///< a direction w has settled when 1 − |w·w_before| is less

  struct Result {
    Eigen::MatrixXd directions;  ///< W, K × K, orthonormal rows: u = W x
    Eigen::VectorXi iterations;  ///< taken, a row of W each
    Eigen::VectorXd change;      ///< 1 − |w·w_before| in the last of them
  };
  /// Directions of greatest non-Gaussianity of white data (K × N: mean 0, covariance I), from a random start.
  Result operator()(const Eigen::MatrixXd& white, Random& random) const;
};

}  // namespace talkgraph
