#include "nodes/mapping/trajectory_error.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/latent/cholesky.h"
#include "nodes/latent/scg.h"

namespace talkgraph {

namespace {

Eigen::Index frames_of(const StatePath& path) { return std::ssize(path.states); }

TrajectoryFit fit(const StateGaussians& states, const StatePath& path, Eigen::Index dimension) {
  const Eigen::Index frames = frames_of(path);
  Eigen::VectorXd precisions = Eigen::VectorXd::Constant(path.rows.rows(), states.smoothness);
  Eigen::VectorXd targets = Eigen::VectorXd::Zero(path.rows.rows());
  for (Eigen::Index kind = 0; kind < states.kinds; ++kind) {
    const Eigen::Index column = kind * states.dimensions() + dimension;
    auto target = targets.segment(kind * frames, frames);
    target = states.means.col(column)(path.states);
    if (path.shifts.size() > 0) target += path.shifts.col(column);
    precisions.segment(kind * frames, frames) =
        path.weights.array() / states.variances.col(column)(path.states).array();
  }
  return {path.rows, std::move(precisions), std::move(targets)};
}

/// By means and logarithms of variances.
struct StateGradient {
  Eigen::MatrixXd by_means, by_logs;

  void add(const StateGaussians& states, const StatePath& path, Eigen::Index dimension,
           const TrajectoryFit::Gradient& by) {
    for (Eigen::Index kind = 0; kind < states.kinds; ++kind) {
      const Eigen::Index column = kind * states.dimensions() + dimension, first = kind * frames_of(path);
      for (Eigen::Index t = 0; t < frames_of(path); ++t) {
        const Eigen::Index state = path.states[static_cast<std::size_t>(t)];
        by_means(state, column) += by.targets(first + t);
        by_logs(state, column) -= by.precisions(first + t) * path.weights(t) / states.variances(state, column);
      }
    }
  }
};

}  // namespace

Eigen::MatrixXd trajectory(const StateGaussians& states, const StatePath& path) {
  Eigen::MatrixXd values(frames_of(path), states.dimensions());
  if (values.rows() == 0) return values;
  for (Eigen::Index d = 0; d < values.cols(); ++d) values.col(d) = fit(states, path, d).trajectory();
  return values;
}

Eigen::VectorXd TrajectoryError::start() const {
  Eigen::VectorXd parameters(size());
  parameters << states_.means.reshaped(), states_.variances.array().log().matrix().reshaped();
  return parameters;
}

StateGaussians TrajectoryError::states(const Eigen::VectorXd& parameters) const {
  StateGaussians s = states_;
  s.means.reshaped() = parameters.head(s.means.size());
  s.variances.reshaped() = parameters.tail(s.means.size()).unaryExpr([](double x) { return std::exp(x); });
  return s;
}

bool TrajectoryError::evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) {
  const StateGaussians now = states(parameters);
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(now.means.rows(), now.means.cols());
  StateGradient sum{none, none};
  const auto count = static_cast<double>(frames_.rows());
  cost = 0;
  Eigen::Index start = 0;
  try {
    for (const StatePath& path : paths_) {
      for (Eigen::Index d = 0; d < now.dimensions(); ++d) {
        const TrajectoryFit fitted = fit(now, path, d);
        const Eigen::VectorXd error = fitted.trajectory() - frames_.col(d).segment(start, frames_of(path));
        cost += 0.5 * error.squaredNorm() / count;
        if (gradient) sum.add(now, path, d, fitted.gradient(error / count));
      }
      start += frames_of(path);
    }
  } catch (const FactorisationError&) {
    return false;
  }
  if (gradient) {
    gradient->resize(size());
    *gradient << sum.by_means.reshaped(), sum.by_logs.reshaped();
  }
  return std::isfinite(cost);
}

std::vector<double> lower_error(StateGaussians& states, const std::vector<StatePath>& paths,
                                const Eigen::MatrixXd& frames, int iterations, const std::string& subject,
                                Context& context) {
  TrajectoryError error(states, paths, frames);
  Eigen::VectorXd parameters = error.start();
  ScaledConjugateGradients descent;
  descent.iterations = iterations;
  descent.on_iteration = [&](int i, double) {
    context.check_cancelled();
    context.progress(static_cast<double>(i) / iterations);
  };
  OptimiserReport report = descent.minimise(error, parameters);
  if (report.trace.empty())
    throw std::runtime_error(
        fmt::format("{}: the trajectories to start from cannot be determined: raise the floor of variances, or ask for "
                    "less smoothness",
                    subject));
  if (report.iterations > 0) states = error.states(parameters);
  std::vector<double> trace = std::move(report.trace);
  for (double& cost : trace) cost *= 2 / static_cast<double>(states.dimensions());
  context.log(fmt::format("{}, {} frames: mean squared error of trajectories {:.4g}, {:.4g} after {} iterations ({})",
                          subject, frames.rows(), trace.front(), trace.back(), report.iterations, str(report.reason)));
  return trace;
}

}  // namespace talkgraph
