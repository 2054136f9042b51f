#include "nodes/latent/sgpdm_objective.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace talkgraph {

SgpdmObjective::SgpdmObjective(SgpdmProblem problem) : problem_(std::move(problem)) {
  Eigen::Index row = 0;
  for (const auto length : problem_.lengths) {
    first_.push_back(row);
    for (std::int64_t t = 1; t < length; ++t) {
      from_.push_back(row + t - 1);
      to_.push_back(row + t);
    }
    row += length;
  }
  std::vector<GpStream*> streams{&problem_.f, &problem_.g};
  if (problem_.h) streams.push_back(&*problem_.h);
  Eigen::Index size = problem_.latents.size();
  for (GpStream* s : streams) {
    places_.push_back({s, size, 0, {}, s->kernel});
    size += s->inducing.size();
  }
  for (Place& place : places_) {
    place.kernel = size;
    size += parameter_count(place.stream->kernel);
  }
  start_.resize(size);
  start_.head(problem_.latents.size()) = problem_.latents.reshaped();
  for (const Place& place : places_) {
    start_.segment(place.inducing, place.stream->inducing.size()) = place.stream->inducing.reshaped();
    start_.segment(place.kernel, parameter_count(place.stream->kernel)) = log_parameters(place.stream->kernel);
  }
  fix();
}

void SgpdmObjective::fix() {
  free_.setOnes(start_.size());
  for (const auto& name : problem_.fixed) {
    bool known = name == "latents" || name == "inducing";
    if (name == "latents") free_.head(problem_.latents.size()).setZero();
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
    const bool absent_dynamics = !problem_.h && name.starts_with("dynamics.");
    if (!known && !absent_dynamics)
      throw std::invalid_argument("\"" + name +
                                  "\" cannot be fixed: give latents, inducing, or audio, visual or dynamics followed "
                                  "by .rbf_variance, .inverse_width, .linear, .bias or .white that its kernel has");
  }
}

SgpdmObjective::View SgpdmObjective::latent_view(const Eigen::VectorXd& p) const {
  return {p.data(), problem_.latents.rows(), problem_.latents.cols()};
}

SgpdmObjective::View SgpdmObjective::inducing_view(const Place& place, const Eigen::VectorXd& p) const {
  return {p.data() + place.inducing, place.stream->inducing.rows(), problem_.latents.cols()};
}

void SgpdmObjective::gather(const View& x) {
  in_.resize(static_cast<Eigen::Index>(from_.size()), x.cols());
  out_.resize(in_.rows(), x.cols());
  for (std::size_t i = 0; i < from_.size(); ++i) {
    in_.row(static_cast<Eigen::Index>(i)) = x.row(from_[i]);
    out_.row(static_cast<Eigen::Index>(i)) = x.row(to_[i]);
  }
}

double SgpdmObjective::stream_likelihood(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x,
                                         const ConstMatrix& y, Eigen::VectorXd* gradient) {
  const GpStream& s = *place.stream;
  const Eigen::Index parameters = parameter_count(s.kernel);
  set_log_parameters(place.now, p.segment(place.kernel, parameters));
  GpGradient* g = nullptr;
  if (gradient) {
    g = &place.gradient;
    g->set_zero(x.rows(), s.inducing.rows(), x.cols(), parameters);
  }
  const double value = s.likelihood->evaluate(place.now, x, inducing_view(place, p), y, g);
  if (gradient) {
    gradient->segment(place.kernel, parameters) += s.weight * g->kernel;
    gradient->segment(place.inducing, s.inducing.size()) += s.weight * g->inducing.reshaped();
  }
  return s.weight * value;
}

double SgpdmObjective::first_points(const View& x, double weight, Eigen::VectorXd* gradient) const {
  const double d = static_cast<double>(x.cols());
  double value = 0;
  for (const auto row : first_) {
    value -= 0.5 * (d * std::log(2 * std::numbers::pi * problem_.first_variance) +
                    x.row(row).squaredNorm() / problem_.first_variance);
    if (!gradient) continue;
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      (*gradient)[c * x.rows() + row] -= weight * x(row, c) / problem_.first_variance;
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

double SgpdmObjective::log_likelihood(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) {
  if (gradient) gradient->setZero(p.size());
  const View x = latent_view(p);
  const double weight = problem_.dynamics_weight;
  double value = hyperprior(p, gradient) + first_points(x, weight, gradient) - problem_.log_scale;
  value += stream_likelihood(places_[0], p, x, problem_.audio, gradient);
  value += stream_likelihood(places_[1], p, x, problem_.visual, gradient);
  if (gradient)
    for (const int i : {0, 1})
      gradient->head(x.size()) += places_[i].stream->weight * places_[i].gradient.inputs.reshaped();
  if (problem_.h) {
    gather(x);
    value += stream_likelihood(places_[2], p, in_, out_, gradient);
    if (gradient) {
      Eigen::Map<Eigen::MatrixXd> x_gradient(gradient->data(), x.rows(), x.cols());
      for (std::size_t i = 0; i < from_.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        x_gradient.row(from_[i]) += problem_.h->weight * places_[2].gradient.inputs.row(row);
        x_gradient.row(to_[i]) += problem_.h->weight * places_[2].gradient.outputs.row(row);
      }
    }
  }
  if (gradient) gradient->array() *= free_.array();
  return value;
}

bool SgpdmObjective::evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) {
  try {
    cost = -log_likelihood(p, gradient);
    if (gradient) *gradient = -*gradient;
    return std::isfinite(cost);
  } catch (const FactorisationError&) {
    return false;
  }
}

Eigen::MatrixXd SgpdmObjective::latents(const Eigen::VectorXd& p) const { return latent_view(p); }

GaussianProcess SgpdmObjective::posterior(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x,
                                          const ConstMatrix& y) {
  set_log_parameters(place.now, p.segment(place.kernel, parameter_count(place.stream->kernel)));
  return place.stream->likelihood->posterior(place.now, x, inducing_view(place, p), y);
}

GaussianProcess SgpdmObjective::audio(const Eigen::VectorXd& p) {
  return posterior(places_[0], p, latent_view(p), problem_.audio);
}

GaussianProcess SgpdmObjective::visual(const Eigen::VectorXd& p) {
  return posterior(places_[1], p, latent_view(p), problem_.visual);
}

std::optional<GaussianProcess> SgpdmObjective::dynamics(const Eigen::VectorXd& p) {
  if (!problem_.h) return std::nullopt;
  gather(latent_view(p));
  return posterior(places_[2], p, in_, out_);
}

double SgpdmObjective::jitter() const {
  double most = 0;
  for (const Place& place : places_) most = std::max(most, place.stream->likelihood->jitter());
  return most;
}

}  // namespace talkgraph
