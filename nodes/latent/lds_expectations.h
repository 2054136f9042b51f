#pragma once

#include "nodes/latent/lds.h"

namespace talkgraph {

/// What expectation maximisation makes a linear dynamical system of: sums over the frames that it gives, and the steps
/// that lead to them.
struct LdsExpectations {
  explicit LdsExpectations(Eigen::Index d);
  /// Frames of one sequence, by their numbers in it, in order.
  void add(const LdsPosterior& p, const std::vector<Eigen::Index>& times);
  /// All frames of a sequence.
  void add(const LdsPosterior& p);

  Eigen::MatrixXd from, to, across;  ///< of [x_{t−1}; 1], x_t, and the one with the other
  Eigen::MatrixXd first;             ///< means of first states, S × d
  Eigen::MatrixXd first_covariance, covariance;
  Eigen::MatrixXd means;  ///< N × d
};

/// Least variances, a direction each.
struct LdsFloors {
  Eigen::VectorXd states, observations;
};

/// The likeliest system given the expectations, and the frames in their order (N × D). What no step leads to keeps its
/// dynamics, what begins no sequence its first state. The noise of the first `apart` dimensions is independent of that
/// of the others.
void maximise(Lds& model, const Eigen::MatrixXd& frames, const LdsExpectations& e, const LdsFloors& floors,
              CovarianceKind kind, Eigen::Index apart = 0);

}  // namespace talkgraph
