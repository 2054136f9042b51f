#include "nodes/latent/gp_objective.h"

#include <fmt/format.h>

namespace talkgraph {

GpObjective::GpObjective(GpLikelihood& likelihood, Kernel kernel, const Eigen::MatrixXd& x, Eigen::MatrixXd inducing,
                         bool fix_inducing, const Eigen::MatrixXd& y)
    : likelihood_(likelihood),
      kernel_(std::move(kernel)),
      x_(x),
      y_(y),
      inducing_(std::move(inducing)),
      moving_(fix_inducing || !likelihood.has_inducing() ? 0 : inducing_.size()) {}

Eigen::Index GpObjective::size() const { return moving_ + parameter_count(kernel_); }

Eigen::VectorXd GpObjective::start() const {
  Eigen::VectorXd parameters(size());
  parameters << inducing_.reshaped().head(moving_), log_parameters(kernel_);
  return parameters;
}

void GpObjective::set(const Eigen::VectorXd& parameters) {
  inducing_.reshaped().head(moving_) = parameters.head(moving_);
  set_log_parameters(kernel_, parameters.tail(parameters.size() - moving_));
}

double GpObjective::compute(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) {
  set(parameters);
  if (!gradient) return likelihood_.evaluate(kernel_, x_, inducing_, y_, nullptr);
  g_.set_zero(x_.rows(), inducing_.rows(), x_.cols(), parameter_count(kernel_));
  const double value = likelihood_.evaluate(kernel_, x_, inducing_, y_, &g_);
  gradient->resize(size());
  *gradient << g_.inducing.reshaped().head(moving_), g_.kernel;
  if (noise_held_) gradient->tail(size() - moving_).array() *= without_noise(kernel_).array();
  return value;
}

std::string GpObjective::name(Eigen::Index parameter) const {
  if (parameter >= moving_) return "log " + parameter_names(kernel_)[static_cast<std::size_t>(parameter - moving_)];
  return fmt::format("inducing point {}, dimension {}", parameter % inducing_.rows(), parameter / inducing_.rows());
}

GaussianProcess GpObjective::posterior(const Eigen::VectorXd& parameters) {
  set(parameters);
  return likelihood_.posterior(kernel_, x_, inducing_, y_);
}

}  // namespace talkgraph
