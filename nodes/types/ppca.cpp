#include "nodes/types/ppca.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <numbers>
#include <stdexcept>

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

Eigen::MatrixXd inner(const Ppca& p) {
  Eigen::MatrixXd m = p.loadings.transpose() * p.loadings;
  m.diagonal().array() += p.noise;
  return m;
}

Eigen::MatrixXd centred(const Ppca& p, const Eigen::MatrixXd& y) {
  if (y.cols() != p.mean.size())
    throw std::runtime_error(
        fmt::format("rows of {} dimensions do not fit principal components of {}", y.cols(), p.mean.size()));
  return y.rowwise() - p.mean;
}

}  // namespace

Eigen::MatrixXd Ppca::posterior_mean(const Eigen::MatrixXd& y) const {
  return inner(*this).llt().solve(loadings.transpose() * centred(*this, y).transpose()).transpose();
}

Eigen::MatrixXd Ppca::posterior_covariance() const {
  return noise * inner(*this).llt().solve(Eigen::MatrixXd::Identity(loadings.cols(), loadings.cols()));
}

Eigen::VectorXd Ppca::log_likelihood(const Eigen::MatrixXd& y) const {
  const double dims = static_cast<double>(mean.size()), d = static_cast<double>(loadings.cols());
  const Eigen::MatrixXd x = posterior_mean(y), unexplained = centred(*this, y) - x * loadings.transpose();
  const Eigen::MatrixXd root = inner(*this).llt().matrixL();
  const double log_determinant = (dims - d) * std::log(noise) + 2 * root.diagonal().array().log().sum();
  const Eigen::VectorXd distance = unexplained.rowwise().squaredNorm() / noise + x.rowwise().squaredNorm();
  return -0.5 * (distance.array() + log_determinant + dims * std::log(2 * std::numbers::pi));
}

void fields(Archive& ar, Ppca& p) {
  ar("mean", p.mean);
  ar("loadings", p.loadings);
  ar("noise", p.noise);
  if (!ar.loading()) return;
  const StoredModel stored("principal components");
  stored.matrix("mean", p.mean, 1, p.mean.size());
  stored.matrix("loadings", p.loadings, p.mean.size(), p.loadings.cols());
  stored.positive("noise", p.noise);
}

}  // namespace talkgraph
