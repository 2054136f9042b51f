#include "nodes/face/pca.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace talkgraph {
namespace {

Eigen::Index modes_to_keep(const Eigen::VectorXd& ascending, double retain) {
  const double total = ascending.sum(), largest = ascending(ascending.size() - 1);
  double sum = 0;
  Eigen::Index kept = 0;
  while (kept < ascending.size() && sum < retain * total) {
    const double next = ascending(ascending.size() - 1 - kept);
    if (next <= 1e-12 * largest) break;
    sum += next;
    ++kept;
  }
  return kept;
}

void fix_signs(Eigen::MatrixXd& modes) {
  for (Eigen::Index i = 0; i < modes.cols(); ++i) {
    Eigen::Index at = 0;
    modes.col(i).cwiseAbs().maxCoeff(&at);
    if (modes(at, i) < 0) modes.col(i) = -modes.col(i);
  }
}

}  // namespace

Pca pca(const Eigen::MatrixXd& columns, double retain) {
  Pca out;
  out.mean = columns.rowwise().mean();
  const Eigen::MatrixXd z = columns.colwise() - out.mean;
  const double n = static_cast<double>(z.cols());
  const bool small = z.rows() > z.cols();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(small ? z.cols() : z.rows(), small ? z.cols() : z.rows());
  if (small)
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(z.transpose(), 1 / n);
  else
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(z, 1 / n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0);
  out.total = values.sum();
  const auto kept = modes_to_keep(values, retain);
  out.variances = values.tail(kept).reverse();
  const Eigen::MatrixXd vectors = eigen.eigenvectors().rightCols(kept).rowwise().reverse();
  out.modes =
      small ? Eigen::MatrixXd(z * vectors * (n * out.variances).cwiseSqrt().cwiseInverse().asDiagonal()) : vectors;
  fix_signs(out.modes);
  return out;
}

}  // namespace talkgraph
