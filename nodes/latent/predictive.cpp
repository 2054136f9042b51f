#include "nodes/latent/predictive.h"

#include <cmath>
#include <numbers>

namespace talkgraph {

void Predictive::compute(const GaussianProcess& gp, const ConstMatrix& x) {
  const Eigen::MatrixXd& k = kernel_.compute(gp.kernel, gp.basis, x);
  mean_.resize(x.rows(), gp.weights.cols());
  mean_.noalias() = k.transpose() * gp.weights;
  variance_.resize(x.rows());
  diagonal(gp.kernel, x, variance_);
  if (gp.root.size() > 0) {
    rooted_.resize(gp.root.cols(), x.rows());
    rooted_.noalias() = gp.root.transpose() * k;
    variance_ -= rooted_.colwise().squaredNorm().transpose();
  } else {
    reduced_.resize(gp.basis.rows(), x.rows());
    reduced_.noalias() = gp.reduction * k;
    variance_ -= reduced_.cwiseProduct(k).colwise().sum().transpose();
  }
  variance_ = variance_.cwiseMax(0);
  variance_.array() += white_variance(gp.kernel);
}

double Predictive::log_density(const ConstMatrix& y) {
  residual_ = y - mean_;
  const double d = static_cast<double>(y.cols());
  return -0.5 * (d * (variance_.array() * (2 * std::numbers::pi)).log().sum() +
                 (residual_.rowwise().squaredNorm().array() / variance_.array()).sum());
}

void Predictive::gradient(const GaussianProcess& gp, const ConstMatrix& x, double weight, MatrixView x_gradient,
                          MatrixView y_gradient) {
  const double d = static_cast<double>(residual_.cols());
  const double noise = white_variance(gp.kernel);
  variance_gradient_ =
      weight * 0.5 * (residual_.rowwise().squaredNorm().array() / variance_.array().square() - d / variance_.array());
  for (Eigen::Index t = 0; t < variance_.size(); ++t)
    if (variance_[t] <= noise) variance_gradient_[t] = 0;
  weights_ = weight / variance_.array();
  residual_.array().colwise() *= weights_.array();
  y_gradient -= residual_;
  if (gp.root.size() > 0) {
    reduced_.resize(gp.basis.rows(), x.rows());
    reduced_.noalias() = gp.root * rooted_;
  }
  g_.resize(gp.basis.rows(), x.rows());
  g_.noalias() = gp.weights * residual_.transpose();
  g_.noalias() -= reduced_ * (2 * variance_gradient_).asDiagonal();
  basis_gradient_.setZero(gp.basis.rows(), gp.basis.cols());
  logs_.setZero(parameter_count(gp.kernel));
  kernel_.gradient(gp.kernel, gp.basis, x, g_, basis_gradient_, x_gradient, logs_);
  diagonal_gradient(gp.kernel, x, variance_gradient_, x_gradient, logs_);
}

Eigen::MatrixXd unscaled(const GaussianProcess& gp, const Eigen::MatrixXd& scaled) {
  return (scaled.array().rowwise() * gp.scale.array()).rowwise() + gp.mean.array();
}

Eigen::MatrixXd scaled(const GaussianProcess& gp, const Eigen::MatrixXd& outputs) {
  return (outputs.array().rowwise() - gp.mean.array()).rowwise() / gp.scale.array();
}

}  // namespace talkgraph
