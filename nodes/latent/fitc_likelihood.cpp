#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

void FitcLikelihood::factorise(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y) {
  const Eigen::Index n = x.rows(), k = u.rows();
  lu_.compute(kuu_.compute(kernel, u, u), base_jitter_, "the covariance of the inducing points");
  note(lu_);
  v_ = kuf_.compute(kernel, u, x);
  lu_.factor().triangularView<Eigen::Lower>().solveInPlace(v_);
  k_diagonal_.resize(n);
  diagonal(kernel, x, k_diagonal_);
  lambda_ = k_diagonal_ - v_.colwise().squaredNorm().transpose();
  lambda_.array() += white_variance(kernel);
  if (!(lambda_.array() > 0).all())
    throw FactorisationError("FITC: a conditional variance is not positive; raise minimum_noise");
  vs_ = v_ * lambda_.cwiseSqrt().cwiseInverse().asDiagonal();
  ys_ = lambda_.cwiseSqrt().cwiseInverse().asDiagonal() * y;
  a_.setIdentity(k, k);
  a_.selfadjointView<Eigen::Lower>().rankUpdate(vs_);
  a_.triangularView<Eigen::StrictlyUpper>() = a_.transpose();
  la_.compute(a_, 0, "the inner matrix of FITC");
  c_.resize(k, y.cols());
  c_.noalias() = vs_ * ys_;
  la_.factor().triangularView<Eigen::Lower>().solveInPlace(c_);
  weights_ = c_;
  la_.factor().transpose().triangularView<Eigen::Upper>().solveInPlace(weights_);
  lu_.factor().transpose().triangularView<Eigen::Upper>().solveInPlace(weights_);
}

double FitcLikelihood::evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                                GpGradient* gradient) {
  const double n = static_cast<double>(y.rows()), d = static_cast<double>(y.cols());
  factorise(kernel, x, u, y);
  const double value =
      -0.5 * (n * d * std::log(2 * std::numbers::pi) + d * (lambda_.array().log().sum() + la_.log_determinant()) +
              ys_.squaredNorm() - c_.squaredNorm());
  if (gradient) differentiate(kernel, x, u, y, *gradient);
  return value;
}

// With Σ = Q + Λ, α = Σ⁻¹Y and G = ½(ααᵀ − DΣ⁻¹) the derivative by Σ, the
// diagonal of Q + Λ does not depend on Q: what reaches Q is G without its
// diagonal g, and g reaches the diagonal of k(X, X) and the noise. Then
//   dL/dK_uf = 2P,  P = ½ωαᵀ − Lu⁻ᵀ(½D·A⁻¹VΛ⁻¹ + V diag(g)),
//   dL/dK_uu = −½ωωᵀ + ½D·Lu⁻ᵀ(I − A⁻¹)Lu⁻¹ + Lu⁻ᵀ V diag(g) Vᵀ Lu⁻¹.
void FitcLikelihood::differentiate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                   const ConstMatrix& y, GpGradient& gradient) {
  const Eigen::Index k = u.rows();
  const double d = static_cast<double>(y.cols());
  const auto lu_transposed = lu_.factor().transpose().triangularView<Eigen::Upper>();
  const auto la_transposed = la_.factor().transpose().triangularView<Eigen::Upper>();

  Eigen::MatrixXd& minus_alpha = gradient.outputs;
  minus_alpha = -y;
  minus_alpha.noalias() += kuf_.value().transpose() * weights_;
  minus_alpha.array().colwise() /= lambda_.array();

  s_ = v_;
  la_.factor().triangularView<Eigen::Lower>().solveInPlace(s_);
  g_diagonal_ = 0.5 * (minus_alpha.rowwise().squaredNorm().array() - d / lambda_.array() +
                       d * s_.colwise().squaredNorm().transpose().array() / lambda_.array().square());

  vs_ = v_ * g_diagonal_.asDiagonal();
  square_.resize(k, k);
  square_.noalias() = vs_ * v_.transpose();
  g_uu_.setIdentity(k, k);
  la_.factor().triangularView<Eigen::Lower>().solveInPlace(g_uu_);
  square_.noalias() -= 0.5 * d * g_uu_.transpose() * g_uu_;
  square_.diagonal().array() += 0.5 * d;
  lu_transposed.solveInPlace(square_);
  square_.transposeInPlace();
  lu_transposed.solveInPlace(square_);
  g_uu_ = 0.5 * (square_ + square_.transpose());
  g_uu_.noalias() -= 0.5 * weights_ * weights_.transpose();
  g_uu_.diagonal().array() += lu_.jitter() * g_uu_.trace() / static_cast<double>(k);

  p_ = s_ * (0.5 * d * lambda_.cwiseInverse()).asDiagonal();
  la_transposed.solveInPlace(p_);
  p_ += vs_;
  lu_transposed.solveInPlace(p_);
  p_ *= -2;
  p_.noalias() -= weights_ * minus_alpha.transpose();

  kuf_.gradient(kernel, u, x, p_, gradient.inducing, gradient.inputs, gradient.kernel);
  kuu_.gradient(kernel, u, u, g_uu_, gradient.inducing, gradient.inducing, gradient.kernel);
  diagonal_gradient(kernel, x, g_diagonal_, gradient.inputs, gradient.kernel);
  white_gradient(kernel, g_diagonal_.sum(), gradient.kernel);
}

GaussianProcess FitcLikelihood::posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                          const ConstMatrix& y) {
  factorise(kernel, x, u, y);
  const Eigen::Index k = u.rows();
  GaussianProcess gp;
  gp.kernel = kernel;
  gp.basis = u;
  gp.weights = weights_;
  Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(k, k);
  lu_.factor().triangularView<Eigen::Lower>().solveInPlace(inner);
  gp.reduction.noalias() = inner.transpose() * inner;
  la_.factor().triangularView<Eigen::Lower>().solveInPlace(inner);
  gp.reduction.noalias() -= inner.transpose() * inner;
  return gp;
}

}  // namespace talkgraph
