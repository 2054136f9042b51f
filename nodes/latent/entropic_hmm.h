#pragma once

#include "graph/context.h"
#include "graph/random.h"
#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/hmm.h"

namespace talkgraph {

/// −Σ p ln p of a distribution.
double entropy(const Eigen::VectorXd& distribution);

/// The distribution that maximises Σ_i counts_i ln p_i − prior · entropy(p) (Brand 1999): p_i = −ω_i / W(−ω_i e^{1+λ}),
/// ω = counts/prior, with λ such that they sum to 1. W is Lambert's function, of its lower branch, but for the largest
/// count where all counts are small. Prior 0 gives counts as shares. Counts are not negative, their sum is positive;
/// what has none gets 0.
Eigen::VectorXd entropic_estimate(const Eigen::VectorXd& counts, double prior);

/// Sets entries of a distribution to 0, and normalises the others, as long as the posterior gains by it to first order:
/// in entropy and in what the others are used, against −ln(1 − count), which what the likelihood loses does not exceed.
/// Says whether it did.
bool trim(Eigen::VectorXd& distribution, Eigen::VectorXd counts, double prior);

/// A hidden Markov model of Gaussian states that maximises ln p(frames) − prior · (entropies of the start, of all
/// transitions from each state, and of the states' Gaussians): the entropic prior of Brand (1999, "Structure learning
/// in conditional probability models via an entropic prior and parameter extinction").
struct EntropicHmm {
  int states = 30;
  double prior = 1;
  CovarianceKind covariance = CovarianceKind::full;
  double floor = 1e-2;
  int iterations = 100;
  double tolerance = 1e-5;

  /// By expectation maximisation from k-means, as TrainHmm. Wherever it has settled, transitions are trimmed and it
  /// goes on, until there is nothing to trim. `trace` has the objective, but for constants. Prior 0 is Baum-Welch,
  /// without trimming.
  Hmm fit(const Sequences& data, Random& random, Context& context) const;
};

}  // namespace talkgraph
