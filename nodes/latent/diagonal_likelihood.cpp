#include <fmt/format.h>

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
  block.conditional = (block.conditional - block.v.rowwise().squaredNorm()).cwiseMax(0);
  const double outputs = static_cast<double>(block.outputs.cols());
  const double added = outputs * noise(block.conditional, white_variance(kernel), block.lambda);
  if (!(block.lambda.array() > 0).all())
    throw FactorisationError(
        fmt::format("the noise of a frame is {}, but must be above 0: raise minimum_noise", block.lambda.minCoeff()));
  block.inverse_root = block.lambda.cwiseSqrt().cwiseInverse();
  block.outputs.array().colwise() *= block.inverse_root.array();
  return added - 0.5 * outputs * block.lambda.array().log().sum();
}

void DiagonalLikelihood::whiten(const Block& block, MatrixView whitened) const {
  whitened = block.inverse_root.asDiagonal() * block.v;
}

void DiagonalLikelihood::add_unwhitened(const Block& block, MatrixView m, MatrixView sum) const {
  sum += block.inverse_root.asDiagonal() * m;
}

bool DiagonalLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block,
                                       const ConstMatrix& alpha, const ConstMatrix& s, MatrixView v_gradient,
                                       MatrixView x_gradient, VectorView logs) {
  const double outputs = static_cast<double>(alpha.cols());
  Eigen::VectorXd& slope = block.slope;
  slope = 0.5 * (alpha.rowwise().squaredNorm().array() -
                 outputs * (1 - s.rowwise().squaredNorm().array()) / block.lambda.array());
  white_gradient(kernel, noise_gradient(block.conditional, white_variance(kernel), outputs, slope), logs);
  if (slope.isZero(0)) return false;
  slope = (block.conditional.array() > 0).select(slope, 0);
  diagonal_gradient(kernel, x, slope, x_gradient, logs);
  v_gradient = (-2 * slope).asDiagonal() * block.v;
  return true;
}

}  // namespace talkgraph
