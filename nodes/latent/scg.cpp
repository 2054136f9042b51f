#include "nodes/latent/scg.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace talkgraph {

namespace {

constexpr double least_scale = 1e-15, most_scale = 1e20, curvature_step = 1e-4;

/// One run, on a state that is complete between iterations.
class Run {
 public:
  Run(const ScaledConjugateGradients& options, Objective& objective, OptimiserState& state)
      : options_(options), objective_(objective), s_(state), c_(state.conjugate), trial_(state.parameters.size()) {}

  void operator()() {
    if (s_.ended()) return;
    OptimiserReport& report = s_.report;
    if (s_.gradient.size() == 0 && !begin()) {
      report.reason = StopReason::failed;
      return;
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options_.seconds);
    report.reason = StopReason::iterations;
    while (report.iterations < options_.iterations && step()) {
      ++report.iterations;
      report.gradient_norm = s_.gradient.lpNorm<Eigen::Infinity>();
      report.trace.push_back(report.cost);
      if (options_.on_iteration) options_.on_iteration(report.iterations, report.cost);
      if (report.reason != StopReason::iterations) return;
      if (std::chrono::steady_clock::now() > end) {
        report.reason = StopReason::time;
        return;
      }
    }
  }

 private:
  bool evaluate(const Eigen::VectorXd& at, double& cost, Eigen::VectorXd& gradient) {
    ++s_.report.evaluations;
    return objective_.evaluate(at, cost, &gradient) && std::isfinite(cost) && gradient.allFinite();
  }

  bool begin() {
    Eigen::VectorXd gradient(trial_.size());
    if (!evaluate(s_.parameters, s_.report.cost, gradient)) return false;
    c_.direction = -gradient;
    s_.gradient.swap(gradient);
    s_.report.gradient_norm = s_.gradient.lpNorm<Eigen::Infinity>();
    if (s_.report.trace.empty()) s_.report.trace.push_back(s_.report.cost);
    return true;
  }

  /// Slope and curvature along the direction. False where it has no length.
  bool look_along_direction() {
    c_.slope = c_.direction.dot(s_.gradient);
    if (c_.slope >= 0) {
      c_.direction = -s_.gradient;
      c_.slope = -s_.gradient.squaredNorm();
    }
    c_.length = c_.direction.squaredNorm();
    if (c_.length < 1e-20) return false;
    const double sigma = curvature_step / std::sqrt(c_.length);
    double cost = 0;
    trial_ = s_.parameters + sigma * c_.direction;
    c_.curvature =
        evaluate(trial_, cost, trial_gradient_) ? c_.direction.dot(trial_gradient_ - s_.gradient) / sigma : 0;
    return true;
  }

  /// One iteration. False where there is no direction; sets the reason where it is the last.
  bool step() {
    OptimiserReport& report = s_.report;
    if (c_.moved && !look_along_direction()) {
      report.reason = StopReason::flat;
      return false;
    }
    double bend = c_.curvature + c_.scale * c_.length;
    if (bend <= 0) {
      bend = c_.scale * c_.length;
      c_.scale -= c_.curvature / c_.length;
    }
    const double step = -c_.slope / bend;
    trial_ = s_.parameters + step * c_.direction;
    double cost = 0;
    const bool evaluated = evaluate(trial_, cost, trial_gradient_);
    const double agreement = evaluated ? 2 * (cost - report.cost) / (step * c_.slope) : -1;
    c_.moved = agreement >= 0;
    if (c_.moved) move(step, cost);
    if (report.reason == StopReason::converged) return true;
    if (agreement < 0.25) c_.scale = std::min(4 * c_.scale, most_scale);
    if (agreement > 0.75) c_.scale = std::max(0.5 * c_.scale, least_scale);
    if (c_.scale >= most_scale) report.reason = StopReason::stalled;
    return true;
  }

  void move(double step, double cost) {
    const double decrease = s_.report.cost - cost;
    const double change = step * c_.direction.cwiseAbs().maxCoeff();
    const double mixing = (s_.gradient - trial_gradient_).dot(trial_gradient_) / c_.slope;
    s_.parameters.swap(trial_);
    s_.gradient.swap(trial_gradient_);
    s_.report.cost = cost;
    if (change < options_.step_tolerance && decrease < options_.cost_tolerance)
      s_.report.reason = StopReason::converged;
    if (++c_.successes == s_.parameters.size()) {
      c_.direction = -s_.gradient;
      c_.successes = 0;
    } else {
      c_.direction = mixing * c_.direction - s_.gradient;
    }
  }

  const ScaledConjugateGradients& options_;
  Objective& objective_;
  OptimiserState& s_;
  ConjugateDirection& c_;
  Eigen::VectorXd trial_, trial_gradient_;
};

}  // namespace

void ScaledConjugateGradients::minimise(Objective& objective, OptimiserState& state) const {
  Run(*this, objective, state)();
}

}  // namespace talkgraph
