#include "nodes/latent/psi_statistics.h"

#include <cmath>

namespace talkgraph {

namespace {

/// Calls f(pair, i, j) for every pair i ≥ j of `count` inducing points.
template <class F>
void each_pair(Eigen::Index count, F f) {
  Eigen::Index pair = 0;
  for (Eigen::Index j = 0; j < count; ++j)
    for (Eigen::Index i = j; i < count; ++i) f(pair++, i, j);
}

}  // namespace

// The product of two RBF kernels at one input is one of twice the inverse width at the middle of the two points:
// k(x, u) k(x, v) = α² exp(−¼ Σ γ (u − v)²) exp(−½ Σ 2γ (x − (u + v)/2)²).
void PsiStatistics::begin(const ArdKernel& kernel, const Eigen::MatrixXd& inducing) {
  const Eigen::Index m = inducing.rows(), d = inducing.cols(), pairs = m * (m + 1) / 2;
  kernel_ = kernel;
  inducing_ = inducing;
  bias_gradient_ = 0;
  midpoints_.resize(pairs, d);
  differences_.resize(pairs, d);
  each_pair(m, [&](Eigen::Index pair, Eigen::Index i, Eigen::Index j) {
    midpoints_.row(pair) = 0.5 * (inducing.row(i) + inducing.row(j));
    differences_.row(pair) = inducing.row(i) - inducing.row(j);
  });
  const double log_variance = std::log(kernel.variance);
  one_.begin(kernel.inverse_widths, inducing, Eigen::VectorXd::Constant(m, log_variance));
  two_.begin(2 * kernel.inverse_widths, midpoints_,
             (2 * log_variance - 0.25 * (differences_.array().square().matrix() * kernel.inverse_widths).array()));
}

const Eigen::MatrixXd& PsiStatistics::first(const ConstMatrix& mean, const ConstMatrix& variance) {
  psi1_ = one_.compute(mean, variance).array() + kernel_.bias;
  return psi1_;
}

void PsiStatistics::add_second(const ConstMatrix& mean, const ConstMatrix& variance, Eigen::MatrixXd& psi2) {
  const double n = static_cast<double>(mean.rows()), bias = kernel_.bias;
  pair_sums_ = two_.compute(mean, variance).colwise().sum().transpose();
  sums_ = one_.value().colwise().sum();
  each_pair(inducing_.rows(), [&](Eigen::Index pair, Eigen::Index i, Eigen::Index j) {
    const double value = pair_sums_[pair] + bias * (sums_[i] + sums_[j] + n * bias);
    psi2(i, j) += value;
    if (i != j) psi2(j, i) += value;
  });
}

void PsiStatistics::first_gradient(const ConstMatrix& g, const ConstMatrix& mean, const ConstMatrix& variance,
                                   MatrixView mean_gradient, MatrixView variance_gradient) {
  bias_gradient_ += g.sum();
  one_.gradient(g, mean, variance, mean_gradient, variance_gradient);
}

void PsiStatistics::gradient(const ConstMatrix& g1, const Eigen::MatrixXd& g2, const ConstMatrix& mean,
                             const ConstMatrix& variance, MatrixView mean_gradient, MatrixView variance_gradient) {
  const double n = static_cast<double>(mean.rows());
  pair_gradient_.resize(midpoints_.rows());
  each_pair(inducing_.rows(), [&](Eigen::Index pair, Eigen::Index i, Eigen::Index j) {
    pair_gradient_[pair] = i == j ? g2(i, i) : 2 * g2(i, j);
  });
  two_.row_sum_gradient(pair_gradient_, mean, variance, mean_gradient, variance_gradient);

  const Eigen::VectorXd by_sums = 2 * g2.rowwise().sum();
  bias_gradient_ += g1.sum() + one_.value().colwise().sum().dot(by_sums) + 2 * kernel_.bias * n * g2.sum();
  rbf_gradient_ = g1.rowwise() + kernel_.bias * by_sums.transpose();
  one_.gradient(rbf_gradient_, mean, variance, mean_gradient, variance_gradient);
}

Eigen::MatrixXd PsiStatistics::inducing_gradient() const {
  Eigen::MatrixXd gradient = one_.points_gradient();
  const Eigen::MatrixXd by_midpoints = 0.5 * two_.points_gradient();
  const Eigen::MatrixXd by_differences =
      -0.5 * ((differences_.array().rowwise() * kernel_.inverse_widths.transpose().array()).colwise() *
              two_.offsets_gradient().array());
  each_pair(inducing_.rows(), [&](Eigen::Index pair, Eigen::Index i, Eigen::Index j) {
    gradient.row(i) += by_midpoints.row(pair) + by_differences.row(pair);
    gradient.row(j) += by_midpoints.row(pair) - by_differences.row(pair);
  });
  return gradient;
}

ArdKernel PsiStatistics::kernel_gradient() const {
  ArdKernel g;
  g.variance = (one_.offsets_gradient().sum() + 2 * two_.offsets_gradient().sum()) / kernel_.variance;
  g.bias = bias_gradient_;
  g.inverse_widths = one_.inverse_widths_gradient() + 2 * two_.inverse_widths_gradient() -
                     0.25 * differences_.array().square().matrix().transpose() * two_.offsets_gradient();
  return g;
}

}  // namespace talkgraph
