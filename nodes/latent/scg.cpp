#include "nodes/latent/scg.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {

std::string str(StopReason reason) {
  switch (reason) {
    case StopReason::converged:
      return "converged";
    case StopReason::flat:
      return "gradient vanished";
    case StopReason::iterations:
      return "iteration limit";
    case StopReason::stalled:
      return "no step lowers the cost";
    case StopReason::failed:
      break;
  }
  return "cost cannot be evaluated";
}

OptimiserReport ScaledConjugateGradients::minimise(Objective& objective, Eigen::VectorXd& x) const {
  constexpr double least_scale = 1e-15, most_scale = 1e20, curvature_step = 1e-4;
  OptimiserReport report;
  const auto evaluate = [&](const Eigen::VectorXd& at, double& cost, Eigen::VectorXd& gradient) {
    ++report.evaluations;
    return objective.evaluate(at, cost, &gradient) && std::isfinite(cost) && gradient.allFinite();
  };

  Eigen::VectorXd gradient(x.size()), trial_gradient(x.size()), trial(x.size());
  if (!evaluate(x, report.cost, gradient)) return report;
  Eigen::VectorXd direction = -gradient;
  double scale = 1, slope = 0, length = 0, curvature = 0;
  bool moved = true;
  Eigen::Index successes = 0;

  for (report.iterations = 0; report.iterations < iterations; ++report.iterations) {
    if (moved) {
      slope = direction.dot(gradient);
      if (slope >= 0) {
        direction = -gradient;
        slope = -gradient.squaredNorm();
      }
      length = direction.squaredNorm();
      if (length < 1e-20) return report.reason = StopReason::flat, report;
      const double sigma = curvature_step / std::sqrt(length);
      double cost = 0;
      trial = x + sigma * direction;
      curvature = evaluate(trial, cost, trial_gradient) ? direction.dot(trial_gradient - gradient) / sigma : 0;
    }
    double bend = curvature + scale * length;
    if (bend <= 0) {
      bend = scale * length;
      scale -= curvature / length;
    }
    const double step = -slope / bend;
    trial = x + step * direction;
    double cost = 0;
    const bool evaluated = evaluate(trial, cost, trial_gradient);
    const double agreement = evaluated ? 2 * (cost - report.cost) / (step * slope) : -1;
    moved = agreement >= 0;
    if (moved) {
      const double decrease = report.cost - cost;
      const double change = step * direction.cwiseAbs().maxCoeff();
      const double mixing = (gradient - trial_gradient).dot(trial_gradient) / slope;
      x.swap(trial);
      gradient.swap(trial_gradient);
      report.cost = cost;
      if (on_iteration) on_iteration(report.iterations + 1, cost);
      if (change < step_tolerance && decrease < cost_tolerance) {
        ++report.iterations;
        return report.reason = StopReason::converged, report;
      }
      if (++successes == x.size()) {
        direction = -gradient;
        successes = 0;
      } else {
        direction = mixing * direction - gradient;
      }
    }
    if (agreement < 0.25) scale = std::min(4 * scale, most_scale);
    if (agreement > 0.75) scale = std::max(0.5 * scale, least_scale);
    if (scale >= most_scale) return report.reason = StopReason::stalled, report;
  }
  report.reason = StopReason::iterations;
  return report;
}

}  // namespace talkgraph
