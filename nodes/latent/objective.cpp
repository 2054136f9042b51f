#include "nodes/latent/objective.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talkgraph {

GradientCheck check_gradient(Objective& objective, const Eigen::VectorXd& parameters, double step) {
  GradientCheck result;
  for (Eigen::Index i = 0; i < parameters.size(); ++i) result.names.push_back(objective.name(i));
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
  const Eigen::ArrayXd size = result.numeric.cwiseAbs();
  const double least = 1e-2 * std::max(1.0, size.maxCoeff());
  result.error = (result.analytic - result.numeric).array().abs() / size.max(least);
  result.worst = result.error.maxCoeff(&result.where);
  return result;
}

std::string GradientCheck::report(std::size_t rows) const {
  if (!evaluated) return "gradient check: the cost could not be evaluated at every point\n";
  std::string text = fmt::format("gradient check of {} parameters: largest error {:.2g}{}{}\n", analytic.size(), worst,
                                 where < 0 ? "" : " at " + names[static_cast<std::size_t>(where)],
                                 cost_consistent ? "" : "; the cost depends on whether the gradient is asked for");
  std::vector<Eigen::Index> order(names.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return error[a] > error[b]; });
  order.resize(std::min(rows, order.size()));
  for (const auto i : order)
    text += fmt::format("{:<32} analytic {:>15.8g}  numeric {:>15.8g}  error {:.2g}\n",
                        names[static_cast<std::size_t>(i)], analytic[i], numeric[i], error[i]);
  return text;
}

}  // namespace talkgraph
