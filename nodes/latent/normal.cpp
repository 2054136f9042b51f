#include "nodes/latent/normal.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "nodes/types/centred.h"

namespace talkgraph {

namespace {

Eigen::VectorXd log_density(const Eigen::VectorXd& distances, double log_determinant, Eigen::Index dims) {
  const double constant = log_determinant + static_cast<double>(dims) * std::log(2 * std::numbers::pi);
  return -0.5 * (distances.array() + constant);
}

[[noreturn]] void refuse(Eigen::Index dims) {
  throw std::runtime_error(
      fmt::format("a covariance of {} dimensions is not positive definite: raise the floor of variances", dims));
}

}  // namespace

Eigen::VectorXd log_normal(const Eigen::LLT<Eigen::MatrixXd>& covariance, const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return Eigen::VectorXd(0);
  const double log_determinant = 2 * covariance.matrixLLT().diagonal().array().log().sum();
  const Eigen::MatrixXd white = covariance.matrixL().solve(columns);
  return log_density(white.colwise().squaredNorm().transpose(), log_determinant, columns.rows());
}

Eigen::VectorXd log_normal(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& columns) {
  if (covariance.cols() > 1) {
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    if (root.info() != Eigen::Success) refuse(covariance.rows());
    return log_normal(root, columns);
  }
  if (!(covariance.array() > 0).all()) refuse(covariance.rows());
  const Eigen::VectorXd distances = covariance.col(0).cwiseInverse().transpose() * columns.cwiseAbs2();
  return log_density(distances, covariance.array().log().sum(), columns.rows());
}

Eigen::MatrixXd precision(const Eigen::MatrixXd& covariance) {
  const Eigen::Index dims = covariance.rows();
  if (covariance.cols() > 1) {
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    if (root.info() != Eigen::Success) refuse(dims);
    return root.solve(Eigen::MatrixXd::Identity(dims, dims));
  }
  if (!(covariance.array() > 0).all()) refuse(dims);
  return covariance.col(0).cwiseInverse().asDiagonal();
}

Eigen::VectorXd variance_floors(const Eigen::MatrixXd& frames, double share) {
  const Eigen::VectorXd variances = centred(frames).deviation.cwiseAbs2();
  const double all = variances.mean();
  return share * (variances.array() > 0).select(variances, all > 0 ? all : 1.0);
}

Eigen::MatrixXd floored(const Eigen::MatrixXd& sample, const Eigen::VectorXd& floors) {
  if (sample.cols() == 1) return sample.cwiseMax(floors);
  const Eigen::VectorXd roots = floors.cwiseSqrt(), inverse = roots.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse.asDiagonal() * sample * inverse.asDiagonal());
  if (eigen.eigenvalues()(0) >= 1) return sample;
  const Eigen::MatrixXd axes = roots.asDiagonal() * eigen.eigenvectors();
  return axes * eigen.eigenvalues().cwiseMax(1).asDiagonal() * axes.transpose();
}

Eigen::MatrixXd scatter(const Eigen::MatrixXd& rows, const Eigen::VectorXd& weights, CovarianceKind kind) {
  if (kind == CovarianceKind::diagonal) return rows.cwiseAbs2().transpose() * weights / weights.sum();
  const Eigen::MatrixXd weighted = weights.cwiseSqrt().asDiagonal() * rows;
  return weighted.transpose() * weighted / weights.sum();
}

Eigen::VectorXd log_sum_rows(const Eigen::MatrixXd& logs) {
  const Eigen::VectorXd most = logs.rowwise().maxCoeff().cwiseMax(std::numeric_limits<double>::lowest());
  const auto ratios = (logs.colwise() - most).unaryExpr([](double x) { return std::exp(x); });
  return most.array() + ratios.rowwise().sum().array().log();
}

}  // namespace talkgraph
