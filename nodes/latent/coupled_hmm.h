#pragma once

#include "graph/context.h"
#include "graph/random.h"
#include "nodes/latent/hmm.h"
#include "nodes/types/coupled_hmm.h"

namespace talkgraph {

/// Expected states and steps of both chains; those lead from pairs of states, K_Y K_Z × K.
struct CoupledExpectations {
  HmmExpectations audio, visual;
};
/// Exact forward-backward over the pairs of states, of sequences of the given lengths, one after the other: N × K_Y and
/// N × K_Z log densities; zeros say nothing. A frame costs (K_Y K_Z)². Gives ln p(frames). Throws std::runtime_error
/// if no path leads through them, which transitions that are all positive rule out.
double expect(const CoupledChain& audio, const CoupledChain& visual, const Eigen::MatrixXd& audio_densities,
              const Eigen::MatrixXd& visual_densities, const std::vector<std::int64_t>& lengths,
              CoupledExpectations& e);

/// A coupled hidden Markov model of two streams, frame by frame. The likelihood of its transitions is that of
/// p(π^y_t | π^y_{t−1}, π^z_{t−1}) and its twin; Eqn 4.56 has products of conditionals in their place, which do not sum
/// to 1.
struct FitCoupledHmm {
  int audio_states = 12;
  int visual_states = 12;
  int mixture = 1;
  CovarianceKind covariance = CovarianceKind::diagonal;
  double floor = 1e-2;
  double prior = 0.1;
  int iterations = 50;
  double tolerance = 1e-4;

  /// By expectation maximisation from k-means of each stream, uncoupled; each transition is counted `prior` > 0 more,
  /// and `trace` has the log-posterior to which this leads. Fills the chains and the trace of the model.
  void operator()(const Eigen::MatrixXd& audio, const Eigen::MatrixXd& visual, const std::vector<std::int64_t>& lengths,
                  CoupledHmm& model, Random& random, Context& context) const;
};

struct Inversion {
  Eigen::MatrixXd frames;     ///< T × D_Z
  std::vector<double> trace;  ///< ln p(audio, frames) at the start and after each iteration
};
/// Baum-Welch inversion (Choi, Luo and Hwang 2001; Xie and Liu 2007): visual frames that make both streams likely given
/// those of the sound, T × D_Y. Expectation maximisation starts from the states given the sound alone; T ≥ 1. Frames
/// in `lost` are not heard.
Inversion invert(const CoupledHmm& model, const Eigen::MatrixXd& audio, const std::vector<std::int64_t>& lost,
                 int iterations);

}  // namespace talkgraph
