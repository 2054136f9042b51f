#pragma once

#include <string>
#include <vector>

#include "graph/value.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// A question about a phone among its neighbours, or a leaf.
struct ContextNode {
  std::int64_t place = 0;    ///< of whom it asks: -1 the phone before, 0 the phone itself, 1 the one after
  std::int64_t viseme = -1;  ///< whether that is of this viseme; -1: whether it is `phone`
  std::string phone;
  std::int64_t yes = 0;  ///< node that follows if so; 0: this is a leaf
  std::int64_t no = 0;   ///< node that follows if not
  std::int64_t row = 0;  ///< of a leaf, its Gaussian
};
template <>
inline constexpr bool is_row<ContextNode> = true;
void fields(Archive& ar, ContextNode& n);

/// Gaussians with diagonal covariances that the states of all phones share, by a tree of questions a position.
struct TiedGaussians {
  std::vector<ContextNode> nodes;  ///< the first are the trees' roots, a position each
  Eigen::MatrixXd means;           ///< a row a leaf
  Eigen::MatrixXd variances;       ///< likewise
};
void fields(Archive& ar, TiedGaussians& g);

/// A hidden Markov model of S states a phone, from left to right, seen through sound and face; both are scaled and have
/// slopes and curvatures beside the frames (Zen, Tokuda and Kitamura 2007).
struct TrajectoryHmm {
  Scaling audio, visual;
  Eigen::VectorXd start;        ///< p(position of a phone's first frame), S
  Eigen::MatrixXd transitions;  ///< from row to column, S × S, upper triangular
  TiedGaussians sound, face;    ///< over 3 D_Y and 3 D_Z
  std::vector<double> trace;    ///< log-likelihood of the training frames at the start and after each iteration
  std::vector<double> errors;   ///< mean squared error of training trajectories, of the descent likewise
};
template <>
inline constexpr PortType port_type<TrajectoryHmm>{"TrajectoryHmm", 1};
void fields(Archive& ar, TrajectoryHmm& h);

}  // namespace talkgraph
