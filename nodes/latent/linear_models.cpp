#include "nodes/latent/linear_models.h"

#include <Eigen/Dense>
#include <algorithm>
#include <stdexcept>

namespace talkgraph {

namespace {

/// Gives every column the sign that makes its largest entry positive, so that
/// the result does not hang on the decomposition's choice.
void fix_signs(Eigen::MatrixXd& columns, Eigen::MatrixXd* along = nullptr) {
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::Index at = 0;
    columns.col(c).cwiseAbs().maxCoeff(&at);
    if (columns(at, c) >= 0) continue;
    columns.col(c) = -columns.col(c);
    if (along) along->col(c) = -along->col(c);
  }
}

Eigen::MatrixXd covariance(const Eigen::MatrixXd& centred) {
  return centred.transpose() * centred / static_cast<double>(centred.rows());
}

Eigen::MatrixXd shrunk(Eigen::MatrixXd covariance, Eigen::Index frames, double shrinkage) {
  const auto dims = covariance.rows();
  const double rho = std::min(1.0, shrinkage * static_cast<double>(dims) / static_cast<double>(dims + frames));
  const double mean = std::max(covariance.trace() / static_cast<double>(dims), 1e-300);
  covariance *= 1 - rho;
  covariance.diagonal().array() += (rho + 1e-10) * mean;
  return covariance;
}

void require_frames(const Eigen::MatrixXd& y) {
  if (y.rows() == 0 || y.cols() == 0) throw std::runtime_error("a latent model needs at least one frame of data");
}

}  // namespace

Ppca fit_ppca(const Eigen::MatrixXd& y, Eigen::Index d) {
  require_frames(y);
  Ppca model;
  model.mean = y.colwise().mean();
  const Eigen::MatrixXd centred = y.rowwise() - model.mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance(centred));
  const Eigen::Index dims = y.cols(), kept = std::min(d, dims);
  const Eigen::VectorXd variances = eigen.eigenvalues().reverse().cwiseMax(0);
  if (dims > kept) model.noise = variances.tail(dims - kept).mean();
  model.noise = std::max(model.noise, 1e-8 * std::max(variances.mean(), 1e-300));
  Eigen::MatrixXd axes = eigen.eigenvectors().rowwise().reverse().leftCols(kept);
  fix_signs(axes);
  model.loadings.setZero(dims, d);
  model.loadings.leftCols(kept) =
      axes * (variances.head(kept).array() - model.noise).max(0.0).sqrt().matrix().asDiagonal();
  return model;
}

Eigen::MatrixXd Ppca::posterior_mean(const Eigen::MatrixXd& y) const {
  Eigen::MatrixXd inner = loadings.transpose() * loadings;
  inner.diagonal().array() += noise;
  return inner.ldlt().solve(loadings.transpose() * (y.rowwise() - mean).transpose()).transpose();
}

Pcca fit_pcca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d, double shrinkage) {
  require_frames(y);
  if (y.rows() != z.rows())
    throw std::runtime_error("PCCA: " + std::to_string(y.rows()) + " frames of one stream but " +
                             std::to_string(z.rows()) + " of the other");
  Pcca model;
  model.mean_y = y.colwise().mean();
  model.mean_z = z.colwise().mean();
  const Eigen::MatrixXd a = y.rowwise() - model.mean_y, b = z.rowwise() - model.mean_z;
  const Eigen::MatrixXd cov_y = shrunk(covariance(a), y.rows(), shrinkage);
  const Eigen::MatrixXd cov_z = shrunk(covariance(b), z.rows(), shrinkage);
  const Eigen::LLT<Eigen::MatrixXd> chol_y(cov_y), chol_z(cov_z);
  Eigen::MatrixXd cross = a.transpose() * b / static_cast<double>(y.rows());
  chol_y.matrixL().solveInPlace(cross);
  Eigen::MatrixXd whitened = cross.transpose();
  chol_z.matrixL().solveInPlace(whitened);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(whitened.transpose(), Eigen::ComputeThinU | Eigen::ComputeThinV);

  const Eigen::Index kept = std::min(d, svd.singularValues().size());
  Eigen::MatrixXd left = svd.matrixU().leftCols(kept), right = svd.matrixV().leftCols(kept);
  fix_signs(left, &right);
  model.correlations.setZero(d);
  model.correlations.head(kept) = svd.singularValues().head(kept).cwiseMin(1);
  model.directions_y.setZero(y.cols(), d);
  model.directions_z.setZero(z.cols(), d);
  model.directions_y.leftCols(kept) = chol_y.matrixU().solve(left);
  model.directions_z.leftCols(kept) = chol_z.matrixU().solve(right);
  const auto root = model.correlations.cwiseSqrt().asDiagonal();
  model.loadings_y = cov_y * model.directions_y * root;
  model.loadings_z = cov_z * model.directions_z * root;
  return model;
}

Eigen::MatrixXd Pcca::posterior_mean(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const {
  const Eigen::VectorXd gain = correlations.array().sqrt() / (1 + correlations.array());
  return ((y.rowwise() - mean_y) * directions_y + (z.rowwise() - mean_z) * directions_z) * gain.asDiagonal();
}

}  // namespace talkgraph
