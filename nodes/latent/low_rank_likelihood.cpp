#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/triangular.h"

namespace talkgraph {

namespace {

/// Adds Aᵀ B, known to be symmetric, to `sum`, of whose upper right quarter nothing is kept.
void add_symmetric(const ConstMatrix& a, const ConstMatrix& b, Eigen::MatrixXd& sum) {
  const Eigen::Index half = sum.rows() / 2, rest = sum.rows() - half;
  sum.topLeftCorner(half, half).noalias() += a.leftCols(half).transpose() * b.leftCols(half);
  sum.bottomRows(rest).noalias() += a.rightCols(rest).transpose() * b;
}

}  // namespace

void LowRankLikelihood::divide(Eigen::Index n) {
  const auto& sizes = lengths(n);
  blocks_.resize(sizes.size());
  Eigen::Index first = 0, most = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    blocks_[i].first = first;
    blocks_[i].n = sizes[i];
    first += sizes[i];
    most = std::max(most, sizes[i]);
  }
  w_.resize(most, a_.cols());
  p_.resize(most, a_.cols());
  residual_.resize(most, c_.cols());
  alpha_.resize(most, c_.cols());
  v_gradient_.resize(most, a_.cols());
}

/// Returns −½ D ln|Λ| and what else the type adds.
double LowRankLikelihood::factorise(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                    const ConstMatrix& y) {
  check(kernel, x, y);
  if (u.rows() == 0 || u.cols() != x.cols())
    throw std::invalid_argument(
        fmt::format("{} inducing points of {} dimensions for inputs of {}: it needs at least "
                    "one, of the same dimension",
                    u.rows(), u.cols(), x.cols()));
  const Eigen::Index k = u.rows();
  lu_.compute(kuu_.compute(kernel, u, u), 0, "the covariance of the inducing points");
  note(lu_);
  a_.setIdentity(k, k);
  c_.setZero(k, y.cols());
  divide(x.rows());
  double value = 0;
  for (Block& block : blocks_) {
    const auto inputs = x.middleRows(block.first, block.n);
    block.cross.compute(kernel, inputs, u, block.v);
    solve_transposed_right(lu_.factor(), block.v);
    block.outputs = y.middleRows(block.first, block.n);
    value += condition(kernel, inputs, block);
    MatrixView w = w_.topRows(block.n);
    whiten(block, w);
    a_.selfadjointView<Eigen::Lower>().rankUpdate(w.transpose());
    c_.noalias() += w.transpose() * block.outputs;
  }
  a_.triangularView<Eigen::StrictlyUpper>() = a_.transpose();
  la_.compute(a_, 0, "the inner matrix I + VᵀΛ⁻¹V");
  la_.factor().triangularView<Eigen::Lower>().solveInPlace(c_);
  b_ = c_;
  la_.factor().triangularView<Eigen::Lower>().transpose().solveInPlace(b_);
  return value;
}

double LowRankLikelihood::evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                   const ConstMatrix& y, GpGradient* gradient) {
  double value = factorise(kernel, x, u, y);
  const double n = static_cast<double>(y.rows()), d = static_cast<double>(y.cols());
  double squares = -c_.squaredNorm();
  for (const Block& block : blocks_) squares += block.outputs.squaredNorm();
  value -= 0.5 * (n * d * std::log(2 * std::numbers::pi) + d * la_.log_determinant() + squares);
  if (gradient) {
    gradient->outputs.resize(y.rows(), y.cols());
    add_gradient(kernel, x, u, *gradient);
  }
  check_finite(value, gradient, x, u, y);
  return value;
}

// Let V not depend on Λ: then dL/dV = α bᵀ − D Λ⁻¹V A⁻¹, b = Vᵀα. What reaches V by way of Λ is added. V reaches the
// likelihood by V Vᵀ alone, so that K_uu has −½ Lu⁻ᵀ E Lu⁻¹ with E = (dL/dV)ᵀ V, to which the first part gives
// b bᵀ − D(I − A⁻¹).
// A is not below I, so that its inverse, of a norm of at most 1, is as good as solving with it.
void LowRankLikelihood::add_gradient(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                     GpGradient& gradient) {
  const double d = static_cast<double>(c_.cols());
  invert_lower(lu_.factor(), lu_inverse_);
  invert_lower(la_.factor(), la_inverse_);
  a_inverse_.setZero(u.rows(), u.rows());
  a_inverse_.selfadjointView<Eigen::Lower>().rankUpdate(la_inverse_.transpose(), -d);
  a_inverse_.triangularView<Eigen::StrictlyUpper>() = a_inverse_.transpose();
  e_ = -a_inverse_;
  e_.diagonal().array() -= d;
  e_.selfadjointView<Eigen::Lower>().rankUpdate(b_);
  for (Block& block : blocks_) {
    const auto inputs = x.middleRows(block.first, block.n);
    MatrixView x_gradient = gradient.inputs.middleRows(block.first, block.n);
    MatrixView w = w_.topRows(block.n), p = p_.topRows(block.n), v_gradient = v_gradient_.topRows(block.n);
    MatrixView residual = residual_.topRows(block.n), alpha = alpha_.topRows(block.n);
    whiten(block, w);
    p.noalias() = w * a_inverse_;
    residual = block.outputs;
    residual.noalias() -= w * b_;
    alpha.setZero();
    add_unwhitened(block, residual, alpha);
    gradient.outputs.middleRows(block.first, block.n) = -alpha;
    if (differentiate(kernel, inputs, block, alpha, w, p, v_gradient, x_gradient, gradient.kernel))
      add_symmetric(v_gradient, block.v, e_);
    else
      v_gradient.setZero();
    add_unwhitened(block, p, v_gradient);
    v_gradient.noalias() += alpha * b_.transpose();
    multiply_right(lu_inverse_, v_gradient);
    block.cross.gradient(kernel, inputs, u, v_gradient, x_gradient, gradient.inducing, gradient.kernel);
  }
  e_.triangularView<Eigen::StrictlyUpper>() = e_.transpose();
  multiply_right(lu_inverse_, e_);
  uu_gradient_ = -0.5 * e_.transpose();
  multiply_right(lu_inverse_, uu_gradient_);
  lu_.add_jitter_gradient(uu_gradient_);
  kuu_.gradient(kernel, u, u, uu_gradient_, gradient.inducing, gradient.inducing, gradient.kernel);
}

// The reduction is Lu⁻ᵀ (I − A⁻¹) Lu⁻¹; the eigenvalues of A are at least 1.
GaussianProcess LowRankLikelihood::posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                             const ConstMatrix& y) {
  factorise(kernel, x, u, y);
  const auto lu_transposed = lu_.factor().transpose().triangularView<Eigen::Upper>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a_);
  GaussianProcess gp;
  gp.kernel = kernel;
  gp.basis = u;
  gp.weights = b_;
  lu_transposed.solveInPlace(gp.weights);
  gp.root = eigen.eigenvectors() * (1 - eigen.eigenvalues().array().max(1).inverse()).sqrt().matrix().asDiagonal();
  lu_transposed.solveInPlace(gp.root);
  return gp;
}

}  // namespace talkgraph
