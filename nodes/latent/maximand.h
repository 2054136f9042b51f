#pragma once

#include "nodes/latent/cholesky.h"
#include "nodes/latent/optimiser.h"

namespace talkgraph {

/// What is to be maximised; its negative is the cost.
class Maximand : public Objective {
 public:
  /// Sets `gradient` unless it is null. Throws FactorisationError where the value or a derivative cannot be computed or
  /// is not finite.
  double value(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient);
  /// False where value() throws FactorisationError.
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) final;
  /// Holds noise variances among the parameters, if any, where they are, or lets go of them.
  virtual void hold_noise(bool /*hold*/) {}

 private:
  virtual double compute(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) = 0;
};

/// As the optimiser minimises the cost; but throws FactorisationError, saying why, if value and gradient cannot be
/// computed at the start.
OptimiserReport maximise(const Optimiser& optimiser, Maximand& maximand, Eigen::VectorXd& parameters);
void maximise(const Optimiser& optimiser, Maximand& maximand, OptimiserState& state);

}  // namespace talkgraph
