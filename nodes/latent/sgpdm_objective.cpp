#include "nodes/latent/sgpdm_objective.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nodes/latent/clock.h"

namespace talkgraph {

SgpdmObjective::SgpdmObjective(SgpdmProblem problem) : problem_(std::move(problem)) {
  find_steps();
  lay_out();
  fix();
}

void SgpdmObjective::find_steps() {
  if (timed()) {
    in_ = times_of(problem_.lengths, problem_.form);
    return;
  }
  Eigen::Index row = 0;
  for (const auto length : problem_.lengths)
    for (std::int64_t t = 0; t < length; ++t, ++row) {
      if (t > 0) {
        from_.push_back(row - 1);
        to_.push_back(row);
      } else {
        first_.push_back(row);
      }
    }
}

void SgpdmObjective::lay_out() {
  for (Observations& o : problem_.observations) {
    places_.push_back({.stream = &o.process,
                       .observed = &o,
                       .now = o.process.kernel,
                       .outputs = {},
                       .gradient = {},
                       .inverse_scale = {}});
    places_.back().outputs = o.values.array().rowwise() / o.scale.array();
  }
  if (problem_.dynamics)
    places_.push_back({.stream = &*problem_.dynamics,
                       .now = problem_.dynamics->kernel,
                       .outputs = {},
                       .gradient = {},
                       .inverse_scale = {}});

  Eigen::VectorXd latents = problem_.latents.reshaped();
  if (problem_.back_constraint) latents = problem_.back_constraint->parameters();
  Eigen::Index size = latent_size_ = latents.size();
  for (Place& place : places_) {
    place.inducing = size;
    size += place.stream->inducing.size();
  }
  for (Place& place : places_) {
    place.scale = size;
    if (place.observed && place.observed->learn_scale) size += place.observed->scale.size();
  }
  for (Place& place : places_) {
    place.kernel = size;
    size += parameter_count(place.stream->kernel);
  }
  start_.resize(size);
  start_.head(latent_size_) = latents;
  for (const Place& place : places_) {
    start_.segment(place.inducing, place.stream->inducing.size()) = place.stream->inducing.reshaped();
    start_.segment(place.kernel, parameter_count(place.stream->kernel)) = log_parameters(place.stream->kernel);
    if (place.observed && place.observed->learn_scale)
      start_.segment(place.scale, place.observed->scale.size()) = place.observed->scale.array().log();
  }
}

std::string SgpdmObjective::name(Eigen::Index i) const {
  const auto entry = [](Eigen::Index at, Eigen::Index rows) {
    return " " + std::to_string(at % rows) + ", dimension " + std::to_string(at / rows);
  };
  if (i < latent_size_ && problem_.back_constraint) return "parameter " + std::to_string(i) + " of the back-constraint";
  if (i < latent_size_) return "latent point" + entry(i, problem_.latents.rows());
  for (const Place& place : places_) {
    const std::string& stream = place.stream->name;
    if (const Eigen::Index at = i - place.inducing; at >= 0 && at < place.stream->inducing.size())
      return stream + " inducing point" + entry(at, place.stream->inducing.rows());
    if (const Eigen::Index at = i - place.scale;
        place.observed && place.observed->learn_scale && at >= 0 && at < place.observed->scale.size())
      return stream + " log scale " + std::to_string(at);
    if (const Eigen::Index at = i - place.kernel; at >= 0 && at < parameter_count(place.stream->kernel))
      return "log " + stream + "." + parameter_names(place.stream->kernel)[static_cast<std::size_t>(at)];
  }
  return Objective::name(i);
}

void SgpdmObjective::fix() {
  free_.setOnes(start_.size());
  noise_.setOnes(start_.size());
  for (const Place& place : places_) {
    if (place.observed && place.observed->learn_scale)
      for (Eigen::Index c = 0; c < place.observed->scale.size(); ++c)
        if (place.observed->values.col(c).isZero(0)) free_[place.scale + c] = 0;
    const Kernel& kernel = place.stream->kernel;
    noise_.segment(place.kernel, parameter_count(kernel)) = without_noise(kernel);
  }
  for (const auto& name : problem_.fixed) {
    bool known = name == "latents" || name == "inducing";
    if (name == "latents") free_.head(latent_size_).setZero();
    for (const Place& place : places_) {
      if (name == "inducing") free_.segment(place.inducing, place.stream->inducing.size()).setZero();
      Eigen::Index i = place.kernel;
      for (const auto& parameter : parameter_names(place.stream->kernel)) {
        if (name == place.stream->name + "." + parameter) {
          free_[i] = 0;
          known = true;
        }
        ++i;
      }
    }
    if (known) continue;
    std::string choices = "latents, inducing";
    for (const Place& place : places_)
      for (const auto& parameter : parameter_names(place.stream->kernel))
        choices += ", " + place.stream->name + "." + parameter;
    throw std::invalid_argument("\"" + name + "\" cannot be fixed: give some of " + choices);
  }
}

SgpdmObjective::View SgpdmObjective::inducing_view(const Place& place, const Eigen::VectorXd& p) const {
  return {p.data() + place.inducing, place.stream->inducing.rows(), place.stream->inducing.cols()};
}

void SgpdmObjective::place_latents(const Eigen::VectorXd& p) {
  if (problem_.back_constraint)
    x_ = problem_.back_constraint->compute(p.head(latent_size_));
  else
    x_ = p.head(latent_size_).reshaped(problem_.latents.rows(), problem_.latents.cols());
}

void SgpdmObjective::place_outputs(Place& place, const Eigen::VectorXd& p) const {
  const Observations& o = *place.observed;
  if (!o.learn_scale) return;
  place.inverse_scale = (-p.segment(place.scale, o.scale.size()).transpose().array()).exp();
  place.outputs = o.values.array().rowwise() * place.inverse_scale.array();
}

void SgpdmObjective::gather_steps() {
  Eigen::MatrixXd& out = places_.back().outputs;
  if (timed()) {
    out = x_;
    return;
  }
  in_.resize(static_cast<Eigen::Index>(from_.size()), x_.cols());
  out.resize(in_.rows(), x_.cols());
  for (Eigen::Index i = 0; i < in_.rows(); ++i) {
    in_.row(i) = x_.row(from_[static_cast<std::size_t>(i)]);
    out.row(i) = x_.row(to_[static_cast<std::size_t>(i)]);
  }
  if (problem_.form == DynamicsForm::difference) out -= in_;
}

double SgpdmObjective::stream_likelihood(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x,
                                         Eigen::VectorXd* gradient) {
  const GpStream& s = *place.stream;
  const Eigen::Index parameters = parameter_count(s.kernel);
  set_log_parameters(place.now, p.segment(place.kernel, parameters));
  GpGradient* g = nullptr;
  if (gradient) {
    g = &place.gradient;
    g->set_zero(x.rows(), s.inducing.rows(), x.cols(), parameters);
  }
  const double value = s.likelihood->evaluate(place.now, x, inducing_view(place, p), place.outputs, g);
  if (gradient) {
    gradient->segment(place.kernel, parameters) += s.weight * g->kernel;
    gradient->segment(place.inducing, s.inducing.size()) += s.weight * g->inducing.reshaped();
  }
  return s.weight * value;
}

double SgpdmObjective::observed_likelihood(Place& place, const Eigen::VectorXd& p, Eigen::VectorXd* gradient) {
  const Observations& o = *place.observed;
  const double weight = place.stream->weight, n = static_cast<double>(o.values.rows());
  place_outputs(place, p);
  const double value = stream_likelihood(place, p, x_, gradient);
  if (gradient) {
    x_gradient_ += weight * place.gradient.inputs;
    if (o.learn_scale)
      gradient->segment(place.scale, o.scale.size()).array() -=
          weight * (place.gradient.outputs.cwiseProduct(place.outputs).colwise().sum().transpose().array() + n);
  }
  const double log_scale = o.learn_scale ? p.segment(place.scale, o.scale.size()).sum() : o.scale.array().log().sum();
  return value - weight * n * log_scale;
}

double SgpdmObjective::dynamics_likelihood(Place& place, const Eigen::VectorXd& p, Eigen::VectorXd* gradient) {
  gather_steps();
  const double value = stream_likelihood(place, p, in_, gradient);
  if (!gradient) return value;
  const double weight = place.stream->weight;
  GpGradient& g = place.gradient;
  if (timed()) {
    x_gradient_ += weight * g.outputs;
    return value;
  }
  if (problem_.form == DynamicsForm::difference) g.inputs -= g.outputs;
  for (Eigen::Index i = 0; i < in_.rows(); ++i) {
    x_gradient_.row(from_[static_cast<std::size_t>(i)]) += weight * g.inputs.row(i);
    x_gradient_.row(to_[static_cast<std::size_t>(i)]) += weight * g.outputs.row(i);
  }
  return value;
}

double SgpdmObjective::first_points(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) {
  if (!problem_.first_variance && !problem_.dynamics) return 0;
  const double weight = problem_.dynamics_weight, d = static_cast<double>(x_.cols()), v = first_variance(p);
  double value = 0, by_variance = 0;
  for (const auto row : first_) {
    const double square = x_.row(row).squaredNorm();
    value -= 0.5 * (d * std::log(2 * std::numbers::pi * v) + square / v);
    by_variance += 0.5 * (square / v - d) / v;
    if (gradient) x_gradient_.row(row) -= weight / v * x_.row(row);
  }
  if (gradient && !problem_.first_variance) {
    const Place& h = places_.back();
    white_gradient(h.now, weight * by_variance, gradient->segment(h.kernel, parameter_count(h.now)));
  }
  return weight * value;
}

double SgpdmObjective::hyperprior(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) const {
  if (problem_.prior_deviation <= 0) return 0;
  const double precision = 1 / (problem_.prior_deviation * problem_.prior_deviation);
  const Eigen::Index from = places_.front().kernel, count = p.size() - from;
  if (gradient) gradient->tail(count) -= precision * (p - start_).tail(count);
  const double normaliser = std::log(2 * std::numbers::pi) - std::log(precision);
  return -0.5 * (precision * (p - start_).tail(count).squaredNorm() + static_cast<double>(count) * normaliser);
}

double SgpdmObjective::compute(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) {
  place_latents(p);
  if (gradient) {
    gradient->setZero(p.size());
    x_gradient_.setZero(x_.rows(), x_.cols());
  }
  double value = hyperprior(p, gradient);
  for (Place& place : places_)
    value += place.observed ? observed_likelihood(place, p, gradient) : dynamics_likelihood(place, p, gradient);
  value += first_points(p, gradient);
  if (!gradient) return value;
  if (problem_.back_constraint)
    problem_.back_constraint->gradient(x_gradient_, gradient->head(latent_size_));
  else
    gradient->head(latent_size_) = x_gradient_.reshaped();
  gradient->array() *= free_.array();
  if (noise_held_) gradient->array() *= noise_.array();
  return value;
}

Eigen::MatrixXd SgpdmObjective::latents(const Eigen::VectorXd& p) {
  place_latents(p);
  return x_;
}

GaussianProcess SgpdmObjective::posterior(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x) {
  set_log_parameters(place.now, p.segment(place.kernel, parameter_count(place.now)));
  return place.stream->likelihood->posterior(place.now, x, inducing_view(place, p), place.outputs);
}

GaussianProcess SgpdmObjective::process(std::size_t stream, const Eigen::VectorXd& p) {
  Place& place = places_.at(stream);
  const Observations& o = problem_.observations.at(stream);
  place_latents(p);
  place_outputs(place, p);
  GaussianProcess gp = posterior(place, p, x_);
  gp.scale = o.scale;
  if (o.learn_scale) gp.scale = p.segment(place.scale, o.scale.size()).array().exp();
  return gp;
}

std::optional<GaussianProcess> SgpdmObjective::dynamics(const Eigen::VectorXd& p) {
  if (!problem_.dynamics) return std::nullopt;
  place_latents(p);
  gather_steps();
  return posterior(places_.back(), p, in_);
}

std::optional<BackConstraint> SgpdmObjective::back_constraint(const Eigen::VectorXd& p) const {
  if (!problem_.back_constraint) return std::nullopt;
  return problem_.back_constraint->with(p.head(latent_size_));
}

double SgpdmObjective::first_variance(const Eigen::VectorXd& p) {
  if (problem_.first_variance || !problem_.dynamics) return problem_.first_variance.value_or(1);
  Place& h = places_.back();
  set_log_parameters(h.now, p.segment(h.kernel, parameter_count(h.now)));
  return white_variance(h.now);
}

double SgpdmObjective::jitter() const {
  double most = 0;
  for (const Place& place : places_) most = std::max(most, place.stream->likelihood->jitter());
  return most;
}

}  // namespace talkgraph
