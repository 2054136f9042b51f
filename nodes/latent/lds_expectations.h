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

struct LdsConstraints {
  Eigen::VectorXd state_floors, noise_floors;  ///< least variances, a direction each
  CovarianceKind covariance = CovarianceKind::full;
  LdsLimits limits;
};

/// The likeliest system given the expectations, and the frames in their order (N × D). What no step leads to keeps its
/// dynamics, what begins no sequence its first state. Where the likeliest A would break the limit, which `model` keeps
/// to, it is approached as far as that allows; so the likelihood never falls.
void maximise(Lds& model, const Eigen::MatrixXd& frames, const LdsExpectations& e, const LdsConstraints& constraints);

}  // namespace talkgraph
