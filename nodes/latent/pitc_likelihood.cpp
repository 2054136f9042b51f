#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

const std::vector<Eigen::Index>& PitcLikelihood::lengths(Eigen::Index n) {
  const auto sum = std::accumulate(lengths_.begin(), lengths_.end(), Eigen::Index{0});
  const bool positive = std::all_of(lengths_.begin(), lengths_.end(), [](Eigen::Index length) { return length > 0; });
  if (sum != n || !positive)
    throw std::invalid_argument(
        fmt::format("PITC: blocks of {} frames in all for {} frames; no block may be empty", sum, n));
  return lengths_;
}

double PitcLikelihood::condition(const Kernel& kernel, const ConstMatrix& x, Block& block) {
  block.covariance = block.own.compute(kernel, x, x);
  block.covariance.noalias() -= block.v * block.v.transpose();
  block.covariance.diagonal().array() += white_variance(kernel);
  block.factor.compute(block.covariance, 0, "PITC: the conditional covariance of a block");
  note(block.factor);
  const auto lower = block.factor.factor().triangularView<Eigen::Lower>();
  block.whitened = block.v;
  lower.solveInPlace(block.whitened);
  lower.solveInPlace(block.outputs);
  return -0.5 * static_cast<double>(block.outputs.cols()) * block.factor.log_determinant();
}

void PitcLikelihood::whiten(const Block& block, MatrixView whitened) const { whitened = block.whitened; }

void PitcLikelihood::add_unwhitened(const Block& block, MatrixView m, MatrixView sum) const {
  block.factor.factor().triangularView<Eigen::Lower>().transpose().solveInPlace(m);
  sum += m;
}

bool PitcLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block, const ConstMatrix& alpha,
                                   const ConstMatrix& w, const ConstMatrix& p, MatrixView v_gradient,
                                   MatrixView x_gradient, VectorView logs) {
  const auto upper = block.factor.factor().triangularView<Eigen::Lower>().transpose();
  Eigen::MatrixXd& g = block.g;
  g.setIdentity(block.n, block.n);
  g *= static_cast<double>(alpha.cols());
  g.noalias() += p * w.transpose();
  upper.solveInPlace(g);
  g.transposeInPlace();
  upper.solveInPlace(g);
  g *= -0.5;
  g.noalias() += 0.5 * alpha * alpha.transpose();
  g.triangularView<Eigen::StrictlyUpper>() = g.transpose();
  block.factor.add_jitter_gradient(g);
  white_gradient(kernel, g.trace(), logs);
  block.own.gradient(kernel, x, x, g, x_gradient, x_gradient, logs);
  v_gradient.noalias() = -2 * g * block.v;
  return true;
}

std::vector<Eigen::Index> blocks_within(const std::vector<std::int64_t>& sequences, Eigen::Index most) {
  std::vector<Eigen::Index> blocks;
  for (const Eigen::Index length : sequences) {
    const Eigen::Index count = (length + most - 1) / most;
    for (Eigen::Index i = 0; i < count; ++i) blocks.push_back((i + 1) * length / count - i * length / count);
  }
  return blocks;
}

}  // namespace talkgraph
