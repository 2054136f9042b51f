#include <fmt/format.h>

#include <algorithm>

#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

const std::vector<Eigen::Index>& DiagonalLikelihood::lengths(Eigen::Index n) {
  constexpr Eigen::Index most = 96;  // a few matrices of as many rows stay in the cache; whole vectors of 8
  const Eigen::Index count = (n + most - 1) / most;
  lengths_.assign(static_cast<std::size_t>(count), most);
  if (count > 0) lengths_.back() = n - (count - 1) * most;
  return lengths_;
}

double DiagonalLikelihood::condition(const Kernel& kernel, const ConstMatrix& x, Block& block) {
  block.conditional.resize(block.n);
  diagonal(kernel, x, block.conditional);
  for (Eigen::Index i = 0; i < block.n; ++i)
    block.conditional[i] = std::max(block.conditional[i] - block.w.col(i).squaredNorm(), 0.0);
  const double outputs = static_cast<double>(block.outputs.rows());
  const double added = outputs * noise(block.conditional, white_variance(kernel), block.lambda);
  if (!(block.lambda.array() > 0).all())
    throw FactorisationError(
        fmt::format("the noise of a frame is {}, but must be above 0: {}", block.lambda.minCoeff(), more_noise));
  block.inverse_root = block.lambda.cwiseSqrt().cwiseInverse();
  unwhiten(block, block.w);
  unwhiten(block, block.outputs);
  return added - 0.5 * outputs * block.lambda.array().log().sum();
}

void DiagonalLikelihood::unwhiten(const Block& block, MatrixView m) const {
  for (Eigen::Index i = 0; i < block.n; ++i) m.col(i) *= block.inverse_root[i];
}

bool DiagonalLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block, const ConstMatrix& rho,
                                       const ConstMatrix& p, MatrixView t, MatrixView x_gradient, VectorView logs) {
  const double outputs = static_cast<double>(rho.rows());
  Eigen::VectorXd& slope = block.slope;
  slope.resize(block.n);
  for (Eigen::Index i = 0; i < block.n; ++i)
    slope[i] = 0.5 * (rho.col(i).squaredNorm() - outputs - block.w.col(i).dot(p.col(i))) / block.lambda[i];
  white_gradient(kernel, noise_gradient(block.conditional, white_variance(kernel), outputs, slope), logs);
  if (slope.isZero(0)) return false;
  slope = (block.conditional.array() > 0).select(slope, 0);
  diagonal_gradient(kernel, x, slope, x_gradient, logs);
  for (Eigen::Index i = 0; i < block.n; ++i) t.col(i) = (-2 * slope[i] * block.lambda[i]) * block.w.col(i);
  return true;
}

}  // namespace talkgraph
