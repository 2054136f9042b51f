#include <fmt/format.h>

#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

const std::vector<Eigen::Index>& DiagonalLikelihood::lengths(Eigen::Index n) {
  constexpr Eigen::Index block = 100;  // a few matrices of 100 frames and 100 inducing points fit the second cache
  const Eigen::Index count = (n + block - 1) / block;
  lengths_.resize(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) lengths_[static_cast<std::size_t>(i)] = (i + 1) * n / count - i * n / count;
  return lengths_;
}

double DiagonalLikelihood::condition(const Kernel& kernel, const ConstMatrix& x, Block& block) {
  diagonal_.resize(block.n);
  diagonal(kernel, x, diagonal_);
  block.conditional = (diagonal_ - block.v.rowwise().squaredNorm()).cwiseMax(0);
  const double outputs = static_cast<double>(block.outputs.cols());
  const double added = outputs * noise(block.conditional, white_variance(kernel), block.lambda);
  if (!(block.lambda.array() > 0).all())
    throw FactorisationError(
        fmt::format("the noise of a frame is {}, but must be above 0: raise minimum_noise", block.lambda.minCoeff()));
  block.root = block.lambda.cwiseSqrt();
  block.whitened.array().colwise() /= block.root.array();
  block.outputs.array().colwise() /= block.root.array();
  return added - 0.5 * outputs * block.lambda.array().log().sum();
}

void DiagonalLikelihood::unwhiten(const Block& block, MatrixView m) const { m.array().colwise() /= block.root.array(); }

void DiagonalLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block,
                                       const ConstMatrix& alpha, const ConstMatrix& s, MatrixView v_gradient,
                                       MatrixView x_gradient, VectorView logs) {
  const double outputs = static_cast<double>(alpha.cols());
  g_ = 0.5 * (alpha.rowwise().squaredNorm().array() -
              outputs * (1 - s.rowwise().squaredNorm().array()) / block.lambda.array());
  white_gradient(kernel, noise_gradient(block.conditional, white_variance(kernel), outputs, g_), logs);
  g_ = (block.conditional.array() > 0).select(g_, 0);
  v_gradient.noalias() -= (2 * g_).asDiagonal() * block.v;
  diagonal_gradient(kernel, x, g_, x_gradient, logs);
}

}  // namespace talkgraph
