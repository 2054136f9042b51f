#include "nodes/latent/lbfgs.h"

#include <lbfgs.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

namespace talkgraph {

namespace {

/// What libLBFGS calls back; nothing may be thrown through it.
class Run {
 public:
  Run(const Lbfgs& options, Objective& objective, OptimiserState& state)
      : options_(options),
        objective_(objective),
        s_(state),
        end_(now() + std::chrono::duration<double>(options.seconds)) {}

  void operator()() {
    Eigen::VectorXd at = s_.parameters;
    if (s_.ended() || !begin(at)) return;
    lbfgs_parameter_t parameters;
    lbfgs_parameter_init(&parameters);
    parameters.m = options_.memory;
    parameters.linesearch = LBFGS_LINESEARCH_BACKTRACKING_STRONG_WOLFE;
    parameters.epsilon = 1e-12;
    const int end = lbfgs(static_cast<int>(at.size()), at.data(), nullptr, evaluate, progress, this, &parameters);
    if (thrown_) std::rethrow_exception(thrown_);
    if (end == LBFGS_SUCCESS || end == LBFGS_ALREADY_MINIMIZED) s_.report.reason = StopReason::flat;
    if (end < 0 && end != LBFGSERR_CANCELED) s_.report.reason = StopReason::stalled;
  }

 private:
  static std::chrono::time_point<std::chrono::steady_clock, std::chrono::duration<double>> now() {
    return std::chrono::steady_clock::now();
  }

  bool begin(const Eigen::VectorXd& at) {
    ++s_.report.evaluations;
    s_.gradient.resize(at.size());
    if (!objective_.evaluate(at, s_.report.cost, &s_.gradient) || !std::isfinite(s_.report.cost) ||
        !s_.gradient.allFinite()) {
      s_.report.reason = StopReason::failed;
      return false;
    }
    s_.report.gradient_norm = s_.gradient.lpNorm<Eigen::Infinity>();
    if (s_.report.trace.empty()) s_.report.trace.push_back(s_.report.cost);
    s_.report.reason = StopReason::iterations;
    if (s_.report.iterations >= options_.iterations) return false;
    if (at.size() == 0) s_.report.reason = StopReason::flat;
    return at.size() > 0;
  }

  static double evaluate(void* run, const double* x, double* gradient, int n, double) {
    return static_cast<Run*>(run)->evaluate(Eigen::Map<const Eigen::VectorXd>(x, n),
                                            Eigen::Map<Eigen::VectorXd>(gradient, n));
  }

  /// Infinite where the cost cannot be evaluated, on which the line search steps back.
  double evaluate(const Eigen::VectorXd& at, Eigen::Map<Eigen::VectorXd> gradient) {
    try {
      ++s_.report.evaluations;
      double cost = 0;
      if (!thrown_ && objective_.evaluate(at, cost, &trial_gradient_) && std::isfinite(cost) &&
          trial_gradient_.allFinite()) {
        gradient = trial_gradient_;
        return cost;
      }
    } catch (...) {
      thrown_ = std::current_exception();
    }
    gradient.setZero();
    return std::numeric_limits<double>::infinity();
  }

  static int progress(void* run, const double* x, const double* gradient, double cost, double, double, double, int n,
                      int, int) {
    return static_cast<Run*>(run)->progress(Eigen::Map<const Eigen::VectorXd>(x, n),
                                            Eigen::Map<const Eigen::VectorXd>(gradient, n), cost);
  }

  /// Not 0 where this iteration is the last.
  int progress(const Eigen::Map<const Eigen::VectorXd>& x, const Eigen::Map<const Eigen::VectorXd>& gradient,
               double cost) {
    OptimiserReport& report = s_.report;
    const double change = (x - s_.parameters).lpNorm<Eigen::Infinity>(), decrease = report.cost - cost;
    s_.parameters = x;
    s_.gradient = gradient;
    report.cost = cost;
    report.gradient_norm = gradient.lpNorm<Eigen::Infinity>();
    report.trace.push_back(cost);
    ++report.iterations;
    if (change < options_.step_tolerance && decrease < options_.cost_tolerance) report.reason = StopReason::converged;
    try {
      if (options_.on_iteration) options_.on_iteration(report.iterations, cost);
    } catch (...) {
      thrown_ = std::current_exception();
      return 1;
    }
    if (report.reason == StopReason::converged) return 1;
    if (now() > end_) report.reason = StopReason::time;
    return report.iterations >= options_.iterations || report.reason == StopReason::time;
  }

  const Lbfgs& options_;
  Objective& objective_;
  OptimiserState& s_;
  std::chrono::time_point<std::chrono::steady_clock, std::chrono::duration<double>> end_;
  std::exception_ptr thrown_;
  Eigen::VectorXd trial_gradient_;
};

}  // namespace

void Lbfgs::minimise(Objective& objective, OptimiserState& state) const { Run(*this, objective, state)(); }

}  // namespace talkgraph
