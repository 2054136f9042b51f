#include "nodes/latent/maximand.h"

#include <fmt/format.h>

#include <cmath>

namespace talkgraph {

double Maximand::value(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) {
  const double result = compute(parameters, gradient);
  if (std::isfinite(result) && (!gradient || gradient->allFinite())) return result;
  throw FactorisationError(fmt::format("what is maximised is {}{}; scale the data, or {}", result,
                                       std::isfinite(result) ? ", but its derivatives are not finite" : "",
                                       more_noise));
}

bool Maximand::evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) {
  try {
    cost = -value(parameters, gradient);
    if (gradient) *gradient = -*gradient;
    return true;
  } catch (const FactorisationError&) {
    return false;
  }
}

OptimiserReport maximise(const Optimiser& optimiser, Maximand& maximand, Eigen::VectorXd& parameters) {
  OptimiserState state;
  state.parameters = parameters;
  maximise(optimiser, maximand, state);
  parameters = state.parameters;
  return std::move(state.report);
}

void maximise(const Optimiser& optimiser, Maximand& maximand, OptimiserState& state) {
  optimiser.minimise(maximand, state);
  if (state.report.reason != StopReason::failed) return;
  Eigen::VectorXd gradient;
  maximand.value(state.parameters, &gradient);
}

}  // namespace talkgraph
