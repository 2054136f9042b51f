#include <fmt/format.h>

#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

namespace {

// Column by column: Eigen's product with a diagonal matrix takes twice as long.
void scale_rows(const Eigen::VectorXd& factors, const ConstMatrix& m, MatrixView scaled) {
  for (Eigen::Index c = 0; c < m.cols(); ++c) scaled.col(c) = m.col(c).cwiseProduct(factors);
}

}  // namespace

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
  scale_rows(block.inverse_root, block.outputs, block.outputs);
  return added - 0.5 * outputs * block.lambda.array().log().sum();
}

void DiagonalLikelihood::whiten(const Block& block, MatrixView whitened) const {
  scale_rows(block.inverse_root, block.v, whitened);
}

void DiagonalLikelihood::add_unwhitened(const Block& block, MatrixView m, MatrixView sum) const {
  for (Eigen::Index c = 0; c < m.cols(); ++c) sum.col(c) += m.col(c).cwiseProduct(block.inverse_root);
}

bool DiagonalLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block,
                                       const ConstMatrix& alpha, const ConstMatrix& w, const ConstMatrix& p,
                                       MatrixView v_gradient, MatrixView x_gradient, VectorView logs) {
  const double outputs = static_cast<double>(alpha.cols());
  Eigen::VectorXd& slope = block.slope;
  slope = 0.5 * (alpha.rowwise().squaredNorm().array() -
                 (outputs + w.cwiseProduct(p).rowwise().sum().array()) / block.lambda.array());
  white_gradient(kernel, noise_gradient(block.conditional, white_variance(kernel), outputs, slope), logs);
  if (slope.isZero(0)) return false;
  slope = (block.conditional.array() > 0).select(slope, 0);
  diagonal_gradient(kernel, x, slope, x_gradient, logs);
  slope *= -2;
  scale_rows(slope, block.v, v_gradient);
  return true;
}

}  // namespace talkgraph
