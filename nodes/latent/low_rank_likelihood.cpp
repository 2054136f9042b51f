#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/triangular.h"

namespace talkgraph {

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
  cross_.resize(a_.rows(), most);
  rho_.resize(c_.cols(), most);
  p_.resize(a_.rows(), most);
  t_.resize(a_.rows(), most);
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
  invert_lower(lu_.factor(), lu_inverse_);
  a_.setIdentity(k, k);
  c_.setZero(k, y.cols());
  divide(x.rows());
  double value = 0;
  for (Block& block : blocks_) {
    const auto inputs = x.middleRows(block.first, block.n);
    MatrixView cross = cross_.leftCols(block.n);
    block.cross.compute(kernel, u, inputs, cross);
    block.w.resize(k, block.n);
    solve_left(lu_.factor(), lu_inverse_, cross, block.w);
    block.outputs = y.middleRows(block.first, block.n).transpose();
    value += condition(kernel, inputs, block);
    add_lower(block.w, block.w, a_);
    c_.noalias() += block.w * block.outputs.transpose();
  }
  a_.triangularView<Eigen::StrictlyUpper>() = a_.transpose();
  la_.compute(a_, 0, "the inner matrix I + VΛ⁻¹Vᵀ");
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

// Let V not depend on Λ: then dL/dV = (b ρ + P) R⁻¹, b = V α. What reaches V by way of Λ, T R⁻¹, is added. V reaches
// the likelihood by Vᵀ V alone, so that K_uu has −½ Lu⁻ᵀ E Lu⁻¹ with E = (dL/dV) Vᵀ, to which the first part gives
// b bᵀ − D(I − A⁻¹).
// A is not below I, so that its inverse, of a norm of at most 1, is as good as solving with it.
void LowRankLikelihood::add_gradient(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                     GpGradient& gradient) {
  const double d = static_cast<double>(c_.cols());
  invert_lower(la_.factor(), la_inverse_);
  a_inverse_.setZero(u.rows(), u.rows());
  a_inverse_.selfadjointView<Eigen::Lower>().rankUpdate(la_inverse_.transpose(), -d);
  a_inverse_.triangularView<Eigen::StrictlyUpper>() = a_inverse_.transpose();
  e_ = -a_inverse_;
  e_.diagonal().array() -= d;
  e_.selfadjointView<Eigen::Lower>().rankUpdate(b_);
  lu_inverse_transposed_ = lu_inverse_.transpose();
  b_transposed_ = b_.transpose();
  for (Block& block : blocks_) {
    const auto inputs = x.middleRows(block.first, block.n);
    MatrixView x_gradient = gradient.inputs.middleRows(block.first, block.n);
    MatrixView rho = rho_.leftCols(block.n), p = p_.leftCols(block.n), t = t_.leftCols(block.n);
    multiply(a_inverse_, block.w, p);
    rho = block.outputs;
    rho.noalias() -= b_transposed_ * block.w;
    if (differentiate(kernel, inputs, block, rho, p, t, x_gradient, gradient.kernel)) {
      add_lower(t, block.w, e_);
      p += t;
    }
    p.noalias() += b_ * rho;
    unwhiten(block, p);
    unwhiten(block, rho);
    gradient.outputs.middleRows(block.first, block.n) = -rho.transpose();
    multiply_upper(lu_inverse_transposed_, p, t);
    block.cross.gradient(kernel, u, inputs, t, gradient.inducing, x_gradient, gradient.kernel);
  }
  e_.triangularView<Eigen::StrictlyUpper>() = e_.transpose();
  uu_gradient_.resize(u.rows(), u.rows());
  multiply_upper(lu_inverse_transposed_, e_, uu_gradient_);
  e_ = -0.5 * uu_gradient_.transpose();
  multiply_upper(lu_inverse_transposed_, e_, uu_gradient_);
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
