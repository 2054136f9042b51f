#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "graph/context.h"
#include "graph/random.h"

namespace talkgraph {

/// What soft contexts compare two frames by, k(i, j) = exp(−Σ_l window_l |(x_{i,l} − x_{j,l}) map|²), where x_{i,l} is
/// what stands at the l-th frame of the window about frame i; and the variance of the noise, of the signal's.
struct ContextKernel {
  Eigen::RowVectorXd window;
  Eigen::MatrixXd map;
  double noise = 1;
};

/// Cholesky's factorisation, in place, of a covariance of training frames, to whose diagonal the noise is added. Only
/// the lower triangle is read. Throws FactorisationError.
Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factorise(Eigen::MatrixXd& covariance, double noise);

/// An utterance from which a kernel is learnt; N frames of which D parameters are known.
struct KernelExample {
  std::vector<Eigen::MatrixXd> around;  ///< for each place l in the window x of all frames, N × C
  Eigen::MatrixXd targets;              ///< N × D
  Eigen::VectorXd counts;               ///< N: 1 where an error counts, otherwise 0
};

/// Mean squared error of a Gaussian process, over parameters and frames that count, when each utterance in turn is left
/// out of what the process learns from; in closed form (docs/method.md §5), with the derivatives by the
/// logarithms of the window and of the noise and by the map. The time grows with the cube of the number of frames.
struct LeftOutError {
  double value = 0;
  ContextKernel gradient;
};
/// Throws FactorisationError. At least one frame must count.
LeftOutError left_out_error(const std::vector<const KernelExample*>& utterances, const ContextKernel& kernel);

/// Steps of Adam (Kingma & Ba 2015) down that error of some utterances, drawn anew for each step.
struct KernelLearning {
  int steps = 40;
  int utterances = 30;
};
/// From window, noise and a map that is 1 to the kernel learnt; the map mixes only dimensions of one group. `groups`
/// has the sizes of the first ones of x; all that is left is one.
ContextKernel learn_kernel(const KernelLearning& learning, const std::vector<KernelExample>& utterances,
                           ContextKernel kernel, const std::vector<Eigen::Index>& groups, Random& random,
                           Context& context);

}  // namespace talkgraph
