#include "nodes/latent/objective.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {

GradientCheck check_gradient(Objective& objective, const Eigen::VectorXd& parameters, double step) {
  GradientCheck result;
  double with = 0, without = 0;
  result.numeric.setZero(parameters.size());
  result.evaluated =
      objective.evaluate(parameters, without, nullptr) && objective.evaluate(parameters, with, &result.analytic);
  result.cost_consistent = with == without;
  Eigen::VectorXd at = parameters;
  for (Eigen::Index i = 0; i < parameters.size() && result.evaluated; ++i) {
    const double h = step * std::max(1.0, std::abs(parameters[i]));
    const auto cost_at = [&](double offset) {
      double cost = 0;
      at[i] = parameters[i] + offset;
      result.evaluated = objective.evaluate(at, cost, nullptr) && result.evaluated;
      return cost;
    };
    result.numeric[i] = (8 * (cost_at(h) - cost_at(-h)) - (cost_at(2 * h) - cost_at(-2 * h))) / (12 * h);
    at[i] = parameters[i];
  }
  if (!result.evaluated || parameters.size() == 0) return result;
  const double size = std::max(1.0, result.numeric.cwiseAbs().maxCoeff());
  result.worst = (result.analytic - result.numeric).cwiseAbs().maxCoeff(&result.where) / size;
  return result;
}

}  // namespace talkgraph
