#include "nodes/latent/expected_rbf.h"

namespace talkgraph {

void ExpectedRbf::begin(const Eigen::VectorXd& inverse_widths, const Eigen::MatrixXd& points,
                        const Eigen::VectorXd& offsets) {
  const Eigen::Index d = points.cols();
  widths_ = inverse_widths;
  centre_ = points.colwise().mean();
  columns_.resize(points.rows(), 2 * d + 2);
  columns_.middleCols(d, d) = points.rowwise() - centre_;
  columns_.leftCols(d) = columns_.middleCols(d, d).array().square();
  columns_.col(2 * d).setOnes();
  columns_.col(2 * d + 1) = offsets;
  column_gradient_.setZero(points.rows(), 2 * d + 2);
  width_gradient_.setZero(d);
}

const Eigen::MatrixXd& ExpectedRbf::compute(const ConstMatrix& mean, const ConstMatrix& variance) {
  const Eigen::Index n = mean.rows(), d = mean.cols();
  shrinkage_ = (variance.array().rowwise() * widths_.transpose().array() + 1).inverse();
  weights_ = shrinkage_.rowwise() * widths_.transpose().array();
  rows_.resize(n, 2 * d + 2);
  rows_.leftCols(d) = -0.5 * weights_;
  const auto m = mean.array().rowwise() - centre_.array();
  rows_.middleCols(d, d) = weights_ * m;
  rows_.col(2 * d) = 0.5 * (shrinkage_.log() - weights_ * m.square()).rowwise().sum();
  rows_.col(2 * d + 1).setOnes();
  value_.resize(n, columns_.rows());
  value_.noalias() = rows_ * columns_.transpose();
  value_ = value_.array().exp();
  return value_;
}

void ExpectedRbf::gradient(const ConstMatrix& g, const ConstMatrix& mean, const ConstMatrix& variance,
                           MatrixView mean_gradient, MatrixView variance_gradient) {
  weighted_ = g.cwiseProduct(value_);
  row_gradient_.resize(rows_.rows(), rows_.cols());
  row_gradient_.noalias() = weighted_ * columns_;
  column_gradient_.noalias() += weighted_.transpose() * rows_;
  chain(mean, variance, mean_gradient, variance_gradient);
}

void ExpectedRbf::row_sum_gradient(const Eigen::VectorXd& g, const ConstMatrix& mean, const ConstMatrix& variance,
                                   MatrixView mean_gradient, MatrixView variance_gradient) {
  weighted_columns_ = columns_.array().colwise() * g.array();
  row_gradient_.resize(rows_.rows(), rows_.cols());
  row_gradient_.noalias() = value_ * weighted_columns_;
  products_.resize(columns_.rows(), columns_.cols());
  products_.noalias() = value_.transpose() * rows_;
  column_gradient_.array() += products_.array().colwise() * g.array();
  chain(mean, variance, mean_gradient, variance_gradient);
}

void ExpectedRbf::chain(const ConstMatrix& mean, const ConstMatrix& variance, MatrixView mean_gradient,
                        MatrixView variance_gradient) {
  const Eigen::Index d = mean.cols();
  const auto m = mean.array().rowwise() - centre_.array();
  const auto squares = row_gradient_.leftCols(d).array(), points = row_gradient_.middleCols(d, d).array();
  const auto total = row_gradient_.col(2 * d).array().replicate(1, d);
  weight_gradient_ = m * points - 0.5 * (squares + m.square() * total);
  mean_gradient.array() += weights_ * (points - m * total);
  variance_gradient.array() -= weights_ * (weights_ * weight_gradient_ + 0.5 * total);
  // By the inverse width, w / (w s + 1) changes as 1 / (w s + 1)² and the logarithm of its root as −s / 2(w s + 1).
  width_gradient_ += (shrinkage_.square() * weight_gradient_ - 0.5 * variance.array() * shrinkage_ * total)
                         .colwise()
                         .sum()
                         .matrix()
                         .transpose();
}

Eigen::MatrixXd ExpectedRbf::points_gradient() const {
  const Eigen::Index d = widths_.size();
  return 2 * column_gradient_.leftCols(d).cwiseProduct(columns_.middleCols(d, d)) + column_gradient_.middleCols(d, d);
}

}  // namespace talkgraph
