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
    if (const auto* ard = std::get_if<ArdTerm>(&term)) {
      double distance = 0;
      for (Eigen::Index c = 0; c < a.size(); ++c) distance += ard->inverse_widths[c] * (a[c] - b[c]) * (a[c] - b[c]);
      sum += ard->variance * std::exp(-0.5 * distance);
    }
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
  const double log_determinant = covariance.selfadjointView<Eigen::Lower>().eigenvalues().array().log().sum();
  return -0.5 * (n * d * std::log(2 * std::numbers::pi) + d * log_determinant +
                 (covariance.inverse() * y * y.transpose()).trace());
}

Eigen::MatrixXd textbook_full(const Kernel& kernel, const Eigen::MatrixXd& x) {
  return textbook_matrix(kernel, x, x) + textbook_white(kernel) * Eigen::MatrixXd::Identity(x.rows(), x.rows());
}

Eigen::MatrixXd textbook_q(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u) {
  const Eigen::MatrixXd kfu = textbook_matrix(kernel, x, u);
  return kfu * textbook_matrix(kernel, u, u).inverse() * kfu.transpose();
}

Eigen::MatrixXd textbook_dtc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u) {
  return textbook_q(kernel, x, u) + textbook_white(kernel) * Eigen::MatrixXd::Identity(x.rows(), x.rows());
}

Eigen::MatrixXd textbook_fitc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u) {
  Eigen::MatrixXd k = textbook_q(kernel, x, u);
  k.diagonal() = textbook_full(kernel, x).diagonal();
  return k;
}

Eigen::MatrixXd textbook_pitc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u,
                              const std::vector<Eigen::Index>& blocks) {
  const Eigen::MatrixXd full = textbook_full(kernel, x);
  Eigen::MatrixXd k = textbook_q(kernel, x, u);
  Eigen::Index first = 0;
  for (const auto n : blocks) {
    k.block(first, first, n, n) = full.block(first, first, n, n);
    first += n;
  }
  return k;
}

double textbook_bound(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u,
                      const Eigen::MatrixXd& y) {
  const double trace = (textbook_matrix(kernel, x, x) - textbook_q(kernel, x, u)).trace();
  return textbook_density(textbook_dtc(kernel, x, u), y) -
         0.5 * static_cast<double>(y.cols()) * trace / textbook_white(kernel);
}

Eigen::MatrixXd textbook_inverse(const Eigen::MatrixXd& a) { return a.inverse(); }

}  // namespace talkgraph::testing
