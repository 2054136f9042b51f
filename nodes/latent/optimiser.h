#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "graph/archive.h"
#include "nodes/latent/objective.h"

namespace talkgraph {

enum class StopReason {
  converged,   ///< step and decrease both below their tolerances
  flat,        ///< the gradient vanished
  iterations,  ///< the iteration limit
  time,        ///< the time limit
  stalled,     ///< no step lowers the cost any more
  failed       ///< the cost could not be evaluated at the start
};
std::string str(StopReason reason);

/// How an optimisation went.
struct OptimiserReport {
  StopReason reason = StopReason::failed;
  int iterations = 0;
  int evaluations = 0;        ///< of cost and gradient together
  double cost = 0;            ///< reached
  double gradient_norm = 0;   ///< there, of the largest component
  std::vector<double> trace;  ///< the cost at the start and after each iteration
};

/// What scaled conjugate gradients keep from one iteration to the next.
struct ConjugateDirection {
  Eigen::VectorXd direction;
  double scale = 1, slope = 0, length = 0, curvature = 0;
  bool moved = true;
  std::int64_t successes = 0;
};

/// Where an optimisation stands, for who wants to interrupt it: saved after some
/// iteration and given to minimise() again, scaled conjugate gradients go on to
/// the same bits; L-BFGS from the same point, with an empty memory.
struct OptimiserState {
  Eigen::VectorXd parameters;
  OptimiserReport report;
  Eigen::VectorXd gradient;
  ConjugateDirection conjugate;

  /// Whether it came to an end that no limit set: there is nothing to go on with.
  bool ended() const;
  /// Keeps point, iterations and trace and forgets the rest, where the objective has changed.
  void restart();
};
void fields(Archive& ar, OptimiserState& state);

/// Lowers the cost of an objective, step by step.
struct Optimiser {
  int iterations = 100;
  double seconds = std::numeric_limits<double>::infinity();  ///< checked after each iteration
  double step_tolerance = 1e-4;                              ///< largest change of a parameter
  double cost_tolerance = 1e-4;                              ///< decrease of the cost
  /// Called after each iteration, when the state is complete; what it throws ends the optimisation.
  std::function<void(int iteration, double cost)> on_iteration;

  virtual ~Optimiser() = default;
  /// Lowers the cost from `parameters`, which receive the best point found, or stay as they are if an exception ends
  /// it.
  OptimiserReport minimise(Objective& objective, Eigen::VectorXd& parameters) const;
  /// Goes on from a state, whose iterations count towards the limit, unless it has ended.
  virtual void minimise(Objective& objective, OptimiserState& state) const = 0;
};

}  // namespace talkgraph
