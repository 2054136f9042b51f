#include "nodes/latent/latent_posterior.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace talkgraph {

namespace {

Eigen::MatrixXd covariance_over_time(Eigen::Index length, double width) {
  constexpr double white = 0.05;
  Eigen::MatrixXd k = Eigen::MatrixXd::Identity(length, length);
  for (Eigen::Index j = 0; j < length && width > 0; ++j)
    for (Eigen::Index i = 0; i < length; ++i)
      if (const double lag = static_cast<double>(i - j) / width; i != j)
        k(i, j) = (1 - white) * std::exp(-0.5 * lag * lag);
  return k;
}

/// (K⁻¹ + diag(λ))⁻¹ by way of B = I + λ^½ K λ^½.
class Covariance {
 public:
  Covariance(const Eigen::MatrixXd& prior, const Eigen::ArrayXd& precision) {
    const Eigen::ArrayXd root = precision.sqrt();
    Eigen::MatrixXd b = root.matrix().asDiagonal() * prior * root.matrix().asDiagonal();
    b.diagonal().array() += 1;
    const Eigen::LLT<Eigen::MatrixXd> llt(b);
    log_determinant = 2 * llt.matrixLLT().diagonal().array().log().sum();
    value = root.matrix().asDiagonal() * prior;
    llt.matrixL().solveInPlace(value);
    value = (prior - value.transpose() * value).eval();
  }
  Eigen::MatrixXd value;
  double log_determinant;  // of B
};

}  // namespace

LatentPosterior::LatentPosterior(const std::vector<std::int64_t>& lengths, double width) : over_time_(width > 0) {
  for (const auto length : lengths) {
    starts_.push_back(rows_);
    lengths_.push_back(length);
    rows_ += length;
  }
  if (!over_time_) return;
  priors_.resize(static_cast<std::size_t>(*std::max_element(lengths_.begin(), lengths_.end())) + 1);
  roots_.resize(priors_.size());
  for (const auto length : lengths_) {
    const auto i = static_cast<std::size_t>(length);
    if (priors_[i].size() > 0) continue;
    priors_[i] = covariance_over_time(length, width);
    roots_[i] = priors_[i].llt().matrixL();
  }
}

Eigen::MatrixXd LatentPosterior::free_mean(const Eigen::MatrixXd& mean) const {
  Eigen::MatrixXd free = mean;
  if (!over_time_) return free;
  for (std::size_t w = 0; w < starts_.size(); ++w) {
    auto block = free.middleRows(starts_[w], lengths_[w]);
    root(w).triangularView<Eigen::Lower>().solveInPlace(block);
  }
  return free;
}

double LatentPosterior::compute(const std::vector<std::size_t>& windows, const ConstMatrix& free_mean,
                                const ConstMatrix& log_precision, Eigen::MatrixXd& mean,
                                Eigen::MatrixXd& variance) const {
  double divergence = 0;
  for (const auto w : windows) {
    const Eigen::Index start = starts_[w], length = lengths_[w];
    const auto free = free_mean.middleRows(start, length);
    const auto precision = log_precision.middleRows(start, length).array().exp();
    auto m = mean.middleRows(start, length);
    auto s = variance.middleRows(start, length);
    divergence += 0.5 * free.squaredNorm();
    if (!over_time_) {
      m = free;
      s = (1 + precision).inverse();
      divergence += 0.5 * ((1 + precision).log() - precision * s.array()).sum();
      continue;
    }
    m.noalias() = root(w) * free;
    for (Eigen::Index q = 0; q < free.cols(); ++q) {
      const Covariance covariance(prior(w), precision.col(q));
      s.col(q) = covariance.value.diagonal();
      divergence += 0.5 * (covariance.log_determinant - (precision.col(q) * s.col(q).array()).sum());
    }
  }
  return divergence;
}

// By the precisions λ, S changes as −S∘S and the divergence as ½ (S∘S) λ.
void LatentPosterior::gradient(const std::vector<std::size_t>& windows, const ConstMatrix& free_mean,
                               const ConstMatrix& log_precision, Eigen::MatrixXd& by_mean,
                               Eigen::MatrixXd& by_variance) const {
  for (const auto w : windows) {
    const Eigen::Index start = starts_[w], length = lengths_[w];
    const auto free = free_mean.middleRows(start, length);
    const Eigen::ArrayXXd precision = log_precision.middleRows(start, length).array().exp();
    auto m = by_mean.middleRows(start, length);
    auto s = by_variance.middleRows(start, length);
    if (over_time_)
      m = root(w).transpose() * m - free;
    else
      m -= free;
    s.array() += 0.5 * precision;
    if (over_time_)
      for (Eigen::Index q = 0; q < free.cols(); ++q)
        s.col(q) = Covariance(prior(w), precision.col(q)).value.array().square().matrix() * s.col(q).eval();
    else
      s.array() *= (1 + precision).square().inverse();
    s.array() *= -precision;
  }
}

}  // namespace talkgraph
