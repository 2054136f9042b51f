#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/hmm.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// A chain of K states that is observed through densities of any kind.
struct MarkovChain {
  Eigen::VectorXd log_start;        ///< K
  Eigen::MatrixXd log_transitions;  ///< from row to column, K × K; −∞ where there is no way
};
MarkovChain chain_of(const Hmm& model);

/// ln p(y_t | state) of every row, T × K.
Eigen::MatrixXd log_densities(const std::vector<GaussianMixture>& states, const Eigen::MatrixXd& frames);
inline Eigen::MatrixXd log_densities(const Hmm& model, const Eigen::MatrixXd& frames) {
  return log_densities(model.observations, frames);
}

struct ChainPosterior {
  Eigen::MatrixXd states;     ///< γ, p(π_t | all frames), T × K
  Eigen::MatrixXd steps;      ///< Σ_t ξ_t, expected number of steps from row to column, K × K
  double log_likelihood = 0;  ///< ln p(frames)
};
/// Forward-backward in logarithms, of one sequence of T ≥ 1 frames' log densities (T × K). A frame of zeros says
/// nothing. Throws std::runtime_error, naming the first frame, if no path leads through the frames.
ChainPosterior forward_backward(const MarkovChain& chain, const Eigen::MatrixXd& log_densities);

struct ChainPath {
  std::vector<Eigen::Index> states;  ///< T
  double log_probability = 0;        ///< ln p(frames, states)
};
/// The likeliest path (Algorithm 2, which ends in the pointers and backtracks with the scores: the reverse is meant).
/// Of equals the lower state. Throws as forward_backward does.
ChainPath viterbi(const MarkovChain& chain, const Eigen::MatrixXd& log_densities);

/// What an expectation step gathers over all sequences.
struct HmmExpectations {
  Eigen::MatrixXd states;  ///< γ, N × K
  Eigen::VectorXd starts;  ///< expected number of sequences that begin in each state, K
  Eigen::MatrixXd steps;   ///< and of steps from row to column, K × K
};
/// Gives ln p(frames). Throws as forward_backward does.
double expect(const Hmm& model, const Sequences& data, HmmExpectations& e);
/// The likeliest mixtures of states given their probabilities, N × K.
void maximise(std::vector<GaussianMixture>& states, const Eigen::MatrixXd& frames, const Eigen::MatrixXd& occupancies,
              const Eigen::VectorXd& floors, CovarianceKind kind);

/// A hidden Markov model of tracks, every run of measured frames a sequence. Throws std::runtime_error, naming the
/// track, if none has a measured frame, on different dimensions and on values that are not finite.
struct TrainHmm {
  int states = 8;
  int mixture = 1;
  CovarianceKind covariance = CovarianceKind::diagonal;
  double floor = 1e-2;
  int iterations = 100;
  double tolerance = 1e-5;

  Hmm operator()(const Collected<Track>& tracks, Random& random, Context& context) const;
  /// By expectation maximisation (Baum-Welch) from k-means: each cluster is a state, transitions are counted, each once
  /// more. There are fewer states, or components of a mixture, if there are fewer distinct frames. What is never
  /// occupied stays as it was.
  Hmm fit(const Sequences& data, Random& random, Context& context) const;
};
void describe(Description<TrainHmm>& d);

/// The states of a track: the likeliest path, labels "0", "1", ... by their rows in the model, and each frame's
/// probabilities. Lost frames count as not observed.
struct DecodeHmm {
  struct Out {
    FrameLabels labels;  ///< T
    Track posteriors;    ///< γ, T × K
  };
  Out operator()(const Hmm& model, const Track& track, Context& context) const;
};
void describe(Description<DecodeHmm>& d);

}  // namespace talkgraph
