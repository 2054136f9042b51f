#include "tests/nodes/latent/textbook.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace talkgraph::testing {

double textbook_kernel(const Kernel& kernel, const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  double sum = 0;
  for (const auto& term : kernel.terms) {
    if (const auto* rbf = std::get_if<RbfTerm>(&term))
      sum += rbf->variance * std::exp(-0.5 * rbf->inverse_width * (a - b).squaredNorm());
    if (const auto* linear = std::get_if<LinearTerm>(&term)) sum += linear->variance * a.dot(b);
    if (const auto* bias = std::get_if<BiasTerm>(&term)) sum += bias->variance;
  }
  return sum;
}

Eigen::MatrixXd textbook_matrix(const Kernel& kernel, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd k(a.rows(), b.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < b.rows(); ++j) k(i, j) = textbook_kernel(kernel, a.row(i), b.row(j));
  return k;
}

double textbook_white(const Kernel& kernel) {
  double sum = 0;
  for (const auto& term : kernel.terms)
    if (const auto* white = std::get_if<WhiteTerm>(&term)) sum += white->variance;
  return sum;
}

double textbook_density(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& y) {
  const double n = static_cast<double>(y.rows()), d = static_cast<double>(y.cols());
  const double log_determinant = covariance.eigenvalues().real().array().log().sum();
  return -0.5 * (n * d * std::log(2 * std::numbers::pi) + d * log_determinant +
                 (covariance.inverse() * y * y.transpose()).trace());
}

Eigen::MatrixXd textbook_full(const Kernel& kernel, const Eigen::MatrixXd& x) {
  return textbook_matrix(kernel, x, x) + textbook_white(kernel) * Eigen::MatrixXd::Identity(x.rows(), x.rows());
}

Eigen::MatrixXd textbook_fitc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u, double jitter) {
  Eigen::MatrixXd kuu = textbook_matrix(kernel, u, u);
  kuu.diagonal().array() += jitter * kuu.diagonal().mean();
  const Eigen::MatrixXd kfu = textbook_matrix(kernel, x, u);
  Eigen::MatrixXd q = kfu * kuu.inverse() * kfu.transpose();
  q.diagonal() = textbook_matrix(kernel, x, x).diagonal();
  return q + textbook_white(kernel) * Eigen::MatrixXd::Identity(x.rows(), x.rows());
}

Eigen::MatrixXd textbook_inverse(const Eigen::MatrixXd& a) { return a.inverse(); }

}  // namespace talkgraph::testing
