#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/triangular.h"

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
  add_lower(-1, block.w, block.w, block.covariance);
  block.covariance.diagonal().array() += white_variance(kernel);
  block.factor.compute(block.covariance, 0, "PITC: the conditional covariance of a block");
  note(block.factor);
  solve_transposed_right(block.factor.factor(), block.w);
  solve_transposed_right(block.factor.factor(), block.outputs);
  return -0.5 * static_cast<double>(block.outputs.rows()) * block.factor.log_determinant();
}

void PitcLikelihood::unwhiten(const Block& block, MatrixView m) const { solve_right(block.factor.factor(), m); }

bool PitcLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block, const ConstMatrix& rho,
                                   const ConstMatrix& p, MatrixView t, MatrixView x_gradient, VectorView logs) {
  const auto& factor = block.factor.factor();
  Eigen::MatrixXd &g = block.g, &whitened = block.whitened_g;
  whitened.setIdentity(block.n, block.n);
  whitened *= -0.5 * static_cast<double>(rho.rows());
  add_lower(-0.5, block.w, p, whitened);
  add_lower(0.5, rho, rho, whitened);
  whitened.triangularView<Eigen::StrictlyUpper>() = whitened.transpose();
  g = whitened;
  solve_right(factor, g);
  g.transposeInPlace();
  solve_right(factor, g);
  g.triangularView<Eigen::StrictlyUpper>() = g.transpose();
  if (const double jitter = block.factor.add_jitter_gradient(g); jitter != 0)
    whitened.noalias() += jitter * factor.transpose() * factor;
  white_gradient(kernel, g.trace(), logs);
  block.own.gradient(kernel, x, x, g, x_gradient, x_gradient, logs);
  whitened *= -2;
  multiply(block.w, whitened, t);
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
