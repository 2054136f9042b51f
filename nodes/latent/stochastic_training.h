#pragma once

#include <functional>
#include <limits>

#include "graph/archive.h"
#include "nodes/latent/bayesian_objective.h"

namespace talkgraph {

/// Raises the bound of a Bayesian latent model on a part of the windows at a time. Each part takes one natural
/// gradient step of the inducing variables (Hensman, Fusi and Lawrence 2013) and one of Adam (Kingma and Ba 2015) on
/// the parameters of the processes and on the latent points of its own frames. A step costs as much for any number of
/// frames in all; memory beyond parameters and data is that of a part.
struct StochasticTraining {
  int batch = 500;            ///< frames of a part, at least; windows stay whole
  int epochs = 50;            ///< each takes every window once, in random order
  int noise_held = 10;        ///< epochs before which noise stays where it is
  double rate = 0.01;         ///< Adam's step of the processes, falling to a tenth
  double latent_rate = 0.05;  ///< that of the latent points
  double tolerance = 0.01;    ///< of what the bound gains in `patience` epochs, a frame; less is the end
  int patience = 10;
  double seconds = std::numeric_limits<double>::infinity();  ///< checked after each epoch
  std::uint64_t seed = 1;                                    ///< of the parts' order
  std::function<void(double share)> on_part;                 ///< called after each part, when the state is complete

  /// Where training stands after a part; the inducing variables stand in the objective.
  struct State {
    Eigen::VectorXd parameters;    ///< now; empty before the first epoch
    Eigen::VectorXd mean, square;  ///< of their gradient, as Adam remembers it
    std::int64_t steps = 0;        ///< parts taken
    std::int64_t part = 0;         ///< those of this epoch
    Eigen::VectorXd best;          ///< the parameters of the greatest bound
    std::vector<double> trace;     ///< the bound of all frames at the start and after each epoch
    std::string ended;             ///< why
  };
  /// From objective.start(), or on from a state to the same bits. Ends, with the best point so far, where a matrix
  /// cannot be factorised any more; throws FactorisationError if none can at the start.
  void operator()(BayesianObjective& objective, State& state) const;
};
void fields(Archive& ar, StochasticTraining::State& state);

}  // namespace talkgraph
