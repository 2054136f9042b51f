#include "nodes/normalise/fast_ica.h"

#include <Eigen/Eigenvalues>

namespace talkgraph {
namespace {

Eigen::MatrixXd random_directions(Eigen::Index count, Random& random) {
  Eigen::MatrixXd w(count, count);
  for (double& value : w.reshaped()) value = random.normal();
  return w;
}

/// W ← (W Wᵀ)^(−½) W
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& w) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(w * w.transpose()).operatorInverseSqrt() * w;
}

/// w⁺ = E[x g(wᵀx)] − E[g′(wᵀx)] w for every row of W.
Eigen::MatrixXd step(const FastIca& options, const Eigen::MatrixXd& w, const Eigen::MatrixXd& white) {
  Eigen::ArrayXXd u = (w * white).array();
  Eigen::VectorXd slope;
  if (options.contrast == Contrast::logcosh) {
    u = (options.a1 * u).tanh();
    slope = options.a1 * (1 - u.square()).rowwise().mean();
  } else {
    const Eigen::ArrayXXd bell = (-0.5 * u.square()).exp();
    slope = ((1 - u.square()) * bell).rowwise().mean();
    u *= bell;
  }
  return u.matrix() * white.transpose() / static_cast<double>(white.cols()) - slope.asDiagonal() * w;
}

Eigen::VectorXd change_of(const Eigen::MatrixXd& w, const Eigen::MatrixXd& before) {
  return 1 - w.cwiseProduct(before).rowwise().sum().array().abs();
}

FastIca::Result all_at_once(const FastIca& options, const Eigen::MatrixXd& white, Random& random) {
  const auto count = white.rows();
  FastIca::Result out{orthonormal(random_directions(count, random)), Eigen::VectorXi::Zero(count),
                      Eigen::VectorXd::Ones(count)};
  for (int i = 1; i <= options.iterations && out.change.maxCoeff() >= options.tolerance; ++i) {
    const Eigen::MatrixXd next = orthonormal(step(options, out.directions, white));
    out.change = change_of(next, out.directions);
    out.iterations.setConstant(i);
    out.directions = next;
  }
  return out;
}

FastIca::Result one_by_one(const FastIca& options, const Eigen::MatrixXd& white, Random& random) {
  const auto count = white.rows();
  FastIca::Result out{random_directions(count, random), Eigen::VectorXi::Zero(count), Eigen::VectorXd::Ones(count)};
  const auto orthogonalise = [&](Eigen::MatrixXd& w, Eigen::Index k) {
    const auto found = out.directions.topRows(k);
    for (int twice = 0; twice < 2; ++twice) w -= w * found.transpose() * found;
    w.normalize();
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::MatrixXd w = out.directions.row(k);
    orthogonalise(w, k);
    for (int i = 1; i <= options.iterations && out.change(k) >= options.tolerance; ++i) {
      Eigen::MatrixXd next = step(options, w, white);
      orthogonalise(next, k);
      out.change(k) = change_of(next, w)(0);
      out.iterations(k) = i;
      w = next;
    }
    out.directions.row(k) = w;
  }
  return out;
}

}  // namespace

FastIca::Result FastIca::operator()(const Eigen::MatrixXd& white, Random& random) const {
  return decorrelation == Decorrelation::symmetric ? all_at_once(*this, white, random)
                                                   : one_by_one(*this, white, random);
}

}  // namespace talkgraph
