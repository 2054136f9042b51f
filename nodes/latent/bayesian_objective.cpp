#include "nodes/latent/bayesian_objective.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talkgraph {

namespace {

/// N·Σ ln scale over the values that are there.
double log_scale_of(const ObservedOutputs& y) {
  double sum = 0;
  for (const auto& c : y.classes)
    for (const auto g : c.groups)
      for (const auto output : y.groups[g]) sum += static_cast<double>(c.rows.size()) * std::log(y.scale[output]);
  return sum;
}

}  // namespace

BayesianObjective::BayesianObjective(LatentPosterior latents, std::vector<VariationalStream> streams,
                                     const Eigen::MatrixXd& mean, double variance)
    : latents_(std::move(latents)), streams_(std::move(streams)), d_(mean.cols()), all_(latents_.windows()) {
  std::iota(all_.begin(), all_.end(), std::size_t{0});
  Eigen::Index size = 2 * mean.size();
  for (const auto& s : streams_) {
    places_.push_back(size);
    size += s.size();
    log_scale_ += log_scale_of(s.outputs());
  }
  start_.resize(size);
  start_.head(mean.size()) = latents_.free_mean(mean).reshaped();
  start_.segment(mean.size(), mean.size()).setConstant(std::log(1 / variance - 1));
  for (std::size_t i = 0; i < streams_.size(); ++i)
    start_.segment(places_[i], streams_[i].size()) = streams_[i].process().parameters();
  q_.set_zero(rows(), d_);
}

double BayesianObjective::compute(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) {
  double value = -log_scale_ - latents_.compute(all_, free_mean(p), log_precision(p), q_.mean, q_.variance);
  Eigen::VectorXd unused;
  if (gradient) {
    gradient->resize(size());
    by_q_.set_zero(rows(), d_);
  }
  Eigen::VectorXd& g = gradient ? *gradient : unused;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    VariationalStream& s = streams_[i];
    s.begin(p.segment(places_[i], s.size()));
    value += gradient ? s.collapsed(q_, &by_q_, g.segment(places_[i], s.size())) : s.collapsed(q_, nullptr, g);
  }
  if (!gradient) return value;
  latents_.gradient(all_, free_mean(p), log_precision(p), by_q_.mean, by_q_.variance);
  g.head(q_.mean.size()) = by_q_.mean.reshaped();
  g.segment(q_.mean.size(), q_.mean.size()) = by_q_.variance.reshaped();
  if (hold_noise_)
    for (std::size_t i = 0; i < streams_.size(); ++i) g[places_[i] + streams_[i].noise_place()] = 0;
  return value;
}

GaussianRows BayesianObjective::posterior(const Eigen::VectorXd& p) const {
  GaussianRows q;
  q.set_zero(rows(), d_);
  latents_.compute(all_, free_mean(p), log_precision(p), q.mean, q.variance);
  return q;
}

double BayesianObjective::jitter() const {
  double most = 0;
  for (const auto& s : streams_) most = std::max(most, s.jitter());
  return most;
}

}  // namespace talkgraph
