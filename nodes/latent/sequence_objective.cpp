#include "nodes/latent/sequence_objective.h"

#include <cmath>
#include <numbers>

namespace talkgraph {

SequenceObjective::SequenceObjective(const Sgpdm& model, const Eigen::MatrixXd& audio, bool with_dynamics)
    : model_(model), audio_(audio), with_dynamics_(with_dynamics && model.dynamics) {}

void SequenceObjective::follow(Eigen::RowVectorXd visual, double weight) {
  before_ = visual;
  follow_weight_ = weight;
}

double SequenceObjective::dynamics(const Eigen::MatrixXd& x, bool with_gradient) {
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
  return weight * value;
}

double SequenceObjective::boundary(const Eigen::MatrixXd& x, bool with_gradient) {
  g_.compute(model_.visual, x.topRows(1));
  const double value = g_.log_density(before_);
  if (with_gradient) {
    visual_gradient_.setZero(1, before_.cols());
    g_.gradient(model_.visual, x.topRows(1), follow_weight_, x_gradient_.topRows(1), visual_gradient_);
  }
  return follow_weight_ * value;
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
  if (follow_weight_ > 0) value += boundary(x_, gradient != nullptr);
  cost = -value;
  if (gradient) *gradient = -x_gradient_.reshaped();
  return std::isfinite(cost);
}

}  // namespace talkgraph
