#include "nodes/latent/back_constraint.h"

#include <Eigen/Dense>
#include <cmath>

#include "graph/random.h"

namespace talkgraph {

namespace {

constexpr double ridge = 1e-3;
constexpr std::uint64_t hidden_seed = 1;

/// φ of every row, N × H.
void compute_features(const HiddenUnits& units, const ConstMatrix& y, Eigen::MatrixXd& phi) {
  phi.noalias() = y * units.weights;
  phi.rowwise() += units.bias;
  phi = phi.array().tanh();
}

Eigen::MatrixXd features(const HiddenUnits& units, const ConstMatrix& y) {
  Eigen::MatrixXd phi;
  compute_features(units, y, phi);
  return phi;
}

Eigen::MatrixXd features(const RbfUnits& units, const ConstMatrix& y) {
  const Eigen::RowVectorXd root = units.inverse_widths.cwiseSqrt();
  const Eigen::MatrixXd a = y * root.asDiagonal(), b = units.centres * root.asDiagonal();
  Eigen::MatrixXd squares = -2 * a * b.transpose();
  squares.colwise() += a.rowwise().squaredNorm();
  squares.rowwise() += b.rowwise().squaredNorm().transpose();
  return (-0.5 * squares.array().max(0.0)).exp();
}

Eigen::MatrixXd features(const BackConstraint& b, const ConstMatrix& y) {
  return std::visit([&](const auto& units) { return features(units, y); }, b.units);
}

void fit_weights(BackConstraint& b, const ConstMatrix& y, const ConstMatrix& x) {
  b.bias = x.colwise().mean();
  const Eigen::MatrixXd phi = features(b, y);
  Eigen::MatrixXd normal = phi.transpose() * phi;
  normal.diagonal().array() += ridge * normal.diagonal().mean() + 1e-12;
  b.weights = normal.ldlt().solve(phi.transpose() * (x.rowwise() - b.bias));
}

/// Calls f(matrix) for each part of the parameters, in order.
template <class B, class F>
void each_part(B& b, F f) {
  f(b.weights);
  f(b.bias);
  if (auto* hidden = std::get_if<HiddenUnits>(&b.units)) {
    f(hidden->weights);
    f(hidden->bias);
  }
}

void write_parameters(const BackConstraint& b, VectorView parameters) {
  Eigen::Index at = 0;
  each_part(b, [&](const auto& part) {
    parameters.segment(at, part.size()) = part.reshaped();
    at += part.size();
  });
}

void read_parameters(BackConstraint& b, const Eigen::Ref<const Eigen::VectorXd>& parameters) {
  Eigen::Index at = 0;
  each_part(b, [&](auto& part) {
    part.reshaped() = parameters.segment(at, part.size());
    at += part.size();
  });
}

}  // namespace

Eigen::MatrixXd latent_points(const BackConstraint& b, const ConstMatrix& y) {
  return (features(b, y) * b.weights).rowwise() + b.bias;
}

BackConstraint perceptron(const ConstMatrix& y, const ConstMatrix& x, Eigen::Index hidden) {
  Random random(hidden_seed);
  const double deviation = 1 / std::sqrt(static_cast<double>(y.cols()));
  HiddenUnits units;
  units.weights = Eigen::MatrixXd::NullaryExpr(y.cols(), hidden, [&] { return deviation * random.normal(); });
  units.bias = Eigen::RowVectorXd::NullaryExpr(hidden, [&] { return random.normal(); });
  BackConstraint b{std::move(units), {}, {}};
  fit_weights(b, y, x);
  return b;
}

BackConstraint kernel_regression(const ConstMatrix& y, const ConstMatrix& x, double inverse_width) {
  BackConstraint b{RbfUnits{y, Eigen::RowVectorXd::Constant(y.cols(), inverse_width)}, {}, {}};
  fit_weights(b, y, x);
  return b;
}

BackConstraint of_rescaled(BackConstraint b, const Eigen::RowVectorXd& ratio) {
  if (auto* hidden = std::get_if<HiddenUnits>(&b.units)) hidden->weights.array().colwise() *= ratio.transpose().array();
  if (auto* rbf = std::get_if<RbfUnits>(&b.units)) {
    rbf->centres.array().rowwise() /= ratio.array();
    rbf->inverse_widths.array() *= ratio.array().square();
  }
  return b;
}

BackProjection::BackProjection(BackConstraint b, Eigen::MatrixXd y)
    : b_(std::move(b)), y_(std::move(y)), features_(features(b_, y_)) {
  if (std::holds_alternative<RbfUnits>(b_.units)) derivative_.units = RbfUnits{};
}

Eigen::Index BackProjection::size() const {
  Eigen::Index n = 0;
  each_part(b_, [&](const auto& part) { n += part.size(); });
  return n;
}

Eigen::VectorXd BackProjection::parameters() const {
  Eigen::VectorXd all(size());
  write_parameters(b_, all);
  return all;
}

BackConstraint BackProjection::with(const Eigen::Ref<const Eigen::VectorXd>& parameters) const {
  BackConstraint b = b_;
  read_parameters(b, parameters);
  return b;
}

const Eigen::MatrixXd& BackProjection::compute(const Eigen::Ref<const Eigen::VectorXd>& parameters) {
  read_parameters(b_, parameters);
  if (const auto* hidden = std::get_if<HiddenUnits>(&b_.units)) compute_features(*hidden, y_, features_);
  x_.noalias() = features_ * b_.weights;
  x_.rowwise() += b_.bias;
  return x_;
}

void BackProjection::gradient(const ConstMatrix& x_gradient, VectorView parameters) {
  derivative_.weights.noalias() = features_.transpose() * x_gradient;
  derivative_.bias = x_gradient.colwise().sum();
  if (auto* hidden = std::get_if<HiddenUnits>(&derivative_.units)) {
    inner_.noalias() = x_gradient * b_.weights.transpose();
    inner_.array() *= 1 - features_.array().square();
    hidden->weights.noalias() = y_.transpose() * inner_;
    hidden->bias = inner_.colwise().sum();
  }
  write_parameters(derivative_, parameters);
}

}  // namespace talkgraph
