#include "nodes/latent/optimiser.h"

namespace talkgraph {

std::string str(StopReason reason) {
  switch (reason) {
    case StopReason::converged:
      return "converged";
    case StopReason::flat:
      return "gradient vanished";
    case StopReason::iterations:
      return "iteration limit";
    case StopReason::time:
      return "time limit";
    case StopReason::stalled:
      return "no step lowers the cost";
    case StopReason::failed:
      break;
  }
  return "cost cannot be evaluated";
}

bool OptimiserState::ended() const {
  const bool by_itself = report.reason == StopReason::converged || report.reason == StopReason::flat ||
                         report.reason == StopReason::stalled;
  return by_itself && gradient.size() > 0;
}

void OptimiserState::restart() {
  OptimiserState fresh;
  fresh.parameters = std::move(parameters);
  fresh.report = std::move(report);
  *this = std::move(fresh);
}

void fields(Archive& ar, OptimiserReport& report) {
  ar("reason", report.reason);
  ar("iterations", report.iterations);
  ar("evaluations", report.evaluations);
  ar("cost", report.cost);
  ar("gradient_norm", report.gradient_norm);
  ar("trace", report.trace);
}

void fields(Archive& ar, ConjugateDirection& c) {
  ar("direction", c.direction);
  ar("scale", c.scale);
  ar("slope", c.slope);
  ar("length", c.length);
  ar("curvature", c.curvature);
  ar("moved", c.moved);
  ar("successes", c.successes);
}

void fields(Archive& ar, OptimiserState& state) {
  ar("parameters", state.parameters);
  ar("report", state.report);
  ar("gradient", state.gradient);
  ar("conjugate", state.conjugate);
}

OptimiserReport Optimiser::minimise(Objective& objective, Eigen::VectorXd& parameters) const {
  OptimiserState state;
  state.parameters = parameters;
  minimise(objective, state);
  parameters = state.parameters;
  return std::move(state.report);
}

}  // namespace talkgraph
