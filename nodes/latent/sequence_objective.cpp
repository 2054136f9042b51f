#include "nodes/latent/sequence_objective.h"

#include <cmath>
#include <numbers>

#include "nodes/latent/clock.h"

namespace talkgraph {

SequenceObjective::SequenceObjective(const Sgpdm& model, const Eigen::MatrixXd& audio, bool with_dynamics)
    : model_(model), audio_(audio), with_dynamics_(with_dynamics && model.dynamics) {
  if (with_dynamics_ && is_timed(model.form)) times_ = times_of({audio.rows()}, model.form);
}

void SequenceObjective::see(Eigen::MatrixXd visual) { seen_ = std::move(visual); }

void SequenceObjective::follow(const Eigen::RowVectorXd& visual, double weight) {
  before_ = visual;
  follow_weight_ = weight;
}

double SequenceObjective::steps(const Eigen::MatrixXd& x, bool with_gradient) {
  const double weight = model_.dynamics_bias, d = static_cast<double>(x.cols());
  const Eigen::Index steps = x.rows() - 1;
  double value = -0.5 * (d * std::log(2 * std::numbers::pi * model_.first_variance) +
                         x.row(0).squaredNorm() / model_.first_variance);
  if (with_gradient) x_gradient_.row(0) -= weight / model_.first_variance * x.row(0);
  if (steps > 0) {
    const auto from = x.topRows(steps);
    step_ = x.bottomRows(steps);
    if (model_.form == DynamicsForm::difference) step_ -= from;
    h_.compute(*model_.dynamics, from);
    value += h_.log_density(step_);
    if (with_gradient) {
      step_gradient_.setZero(steps, x.cols());
      h_.gradient(*model_.dynamics, from, weight, x_gradient_.topRows(steps), step_gradient_);
      x_gradient_.bottomRows(steps) += step_gradient_;
      if (model_.form == DynamicsForm::difference) x_gradient_.topRows(steps) -= step_gradient_;
    }
  }
  return value;
}

double SequenceObjective::at_times(const Eigen::MatrixXd& x, bool with_gradient) {
  h_.compute(*model_.dynamics, times_);
  const double value = h_.log_density(x);
  if (with_gradient) {
    times_gradient_.setZero(times_.rows(), 1);
    h_.gradient(*model_.dynamics, times_, model_.dynamics_bias, times_gradient_, x_gradient_);
  }
  return value;
}

double SequenceObjective::dynamics(const Eigen::MatrixXd& x, bool with_gradient) {
  return model_.dynamics_bias * (is_timed(model_.form) ? at_times(x, with_gradient) : steps(x, with_gradient));
}

double SequenceObjective::visual(const Eigen::MatrixXd& frames, double weight, bool with_gradient) {
  const auto x = x_.topRows(frames.rows());
  g_.compute(model_.visual, x);
  const double value = g_.log_density(frames);
  if (with_gradient) {
    visual_gradient_.setZero(frames.rows(), frames.cols());
    g_.gradient(model_.visual, x, weight, x_gradient_.topRows(frames.rows()), visual_gradient_);
  }
  return weight * value;
}

bool SequenceObjective::evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) {
  x_ = parameters.reshaped(audio_.rows(), model_.latents.cols());
  f_.compute(model_.audio, x_);
  double value = f_.log_density(audio_);
  if (gradient) {
    x_gradient_.setZero(x_.rows(), x_.cols());
    audio_gradient_.setZero(audio_.rows(), audio_.cols());
    f_.gradient(model_.audio, x_, 1, x_gradient_, audio_gradient_);
  }
  if (with_dynamics_) value += dynamics(x_, gradient != nullptr);
  if (follow_weight_ > 0) value += visual(before_, follow_weight_, gradient != nullptr);
  if (seen_.rows() > 0) value += visual(seen_, 1, gradient != nullptr);
  cost = -value;
  if (gradient) *gradient = -x_gradient_.reshaped();
  return std::isfinite(cost);
}

}  // namespace talkgraph
