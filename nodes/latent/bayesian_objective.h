#pragma once

#include <Eigen/Core>
#include <vector>

#include "nodes/latent/latent_posterior.h"
#include "nodes/latent/maximand.h"
#include "nodes/latent/variational_stream.h"

namespace talkgraph {

/// Variational bound of ln p of one or several streams over one latent space:
///   Σ_streams (collapsed bound − N·Σ ln scale) − KL(q(X) ‖ p(X)).
/// With one stream it is the Bayesian GPLVM (Titsias and Lawrence 2010), with several manifold relevance
/// determination (Damianou, Ek, Titsias and Lawrence 2012). Parameters are the free mean and log precision of
/// `latents` (N × d each, column by column), then each stream's process.
class BayesianObjective : public Maximand {
 public:
  /// `mean` (N × d) is where q(X) starts, with variances `variance` in (0, 1) without a prior over time.
  BayesianObjective(LatentPosterior latents, std::vector<VariationalStream> streams, const Eigen::MatrixXd& mean,
                    double variance);

  Eigen::Index size() const override { return start_.size(); }

  const Eigen::VectorXd& start() const { return start_; }
  void hold_noise(bool hold) override { hold_noise_ = hold; }

  Eigen::Index rows() const { return latents_.rows(); }
  Eigen::Index dimension() const { return d_; }
  const LatentPosterior& latents() const { return latents_; }
  std::vector<VariationalStream>& streams() { return streams_; }
  Eigen::Index place(std::size_t stream) const { return places_[stream]; }  ///< of its first parameter
  /// q(X), N × d.
  GaussianRows posterior(const Eigen::VectorXd& parameters) const;
  double jitter() const;

 private:
  using View = Eigen::Map<const Eigen::MatrixXd>;
  double compute(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) override;
  View free_mean(const Eigen::VectorXd& p) const { return {p.data(), rows(), d_}; }
  View log_precision(const Eigen::VectorXd& p) const { return {p.data() + rows() * d_, rows(), d_}; }

  LatentPosterior latents_;
  std::vector<VariationalStream> streams_;
  Eigen::Index d_;
  std::vector<Eigen::Index> places_;
  std::vector<std::size_t> all_;
  Eigen::VectorXd start_;
  GaussianRows q_, by_q_;
  double log_scale_ = 0;
  bool hold_noise_ = false;
};

}  // namespace talkgraph
