#pragma once

#include <vector>

#include "graph/context.h"
#include "nodes/types/context_gp.h"

namespace talkgraph {

/// Some of the training frames, those of one utterance.
struct ContextBlock {
  std::size_t utterance;            ///< its number
  Eigen::MatrixXd frames;           ///< all that it has, T × C
  Eigen::Index at;                  ///< how many of the frames are of utterances before it
  std::vector<Eigen::Index> local;  ///< those of this one, counted from its first

  auto size() const { return static_cast<Eigen::Index>(local.size()); }
};
/// Training frames, numbered as in `model.frames` and in that order, by utterance; none of an utterance without any.
std::vector<ContextBlock> blocks_of(const ContextGp& model, const std::vector<Eigen::Index>& rows);

/// Kernel of some of an utterance's frames (T × C), a row each, with all training frames.
Eigen::MatrixXd kernel_with_training(const ContextGp& model, const Eigen::MatrixXd& frames,
                                     const std::vector<Eigen::Index>& some);

/// Cholesky's factor, in the lower triangle, of the covariance of training frames with its noise. Throws
/// FactorisationError.
Eigen::MatrixXd covariance_factor(const ContextGp& model, const std::vector<Eigen::Index>& rows, Context& context);

}  // namespace talkgraph
