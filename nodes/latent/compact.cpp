#include "nodes/latent/compact.h"

#include <Eigen/QR>
#include <bit>
#include <cstdint>

#include "nodes/latent/predictive.h"

namespace talkgraph {

namespace {

/// To the nearest double whose lower 32 bits are zero.
double rounded(double value) {
  constexpr std::uint64_t half = std::uint64_t{1} << 31, below = ~std::uint64_t{0xffffffff};
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(value) + half) & below);
}

/// L with L Lᵀ = root · rootᵀ.
Eigen::MatrixXd lower_root(const Eigen::MatrixXd& root) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(root.transpose());
  return qr.matrixQR().topRows(root.rows()).triangularView<Eigen::Upper>().toDenseMatrix().transpose();
}

bool predicts_alike(const GaussianProcess& a, const GaussianProcess& b, const ConstMatrix& x) {
  constexpr double share = 1e-3;
  Predictive p, q;
  p.compute(a, x);
  q.compute(b, x);
  const Eigen::ArrayXd variance = p.variance();
  const Eigen::ArrayXd moved = (p.mean() - q.mean()).cwiseAbs().rowwise().maxCoeff();
  return (moved <= share * variance.sqrt()).all() &&
         ((q.variance().array() - variance).abs() <= share * variance).all();
}

}  // namespace

Eigen::MatrixXd rounded(const Eigen::MatrixXd& m) {
  return m.unaryExpr([](double v) { return rounded(v); });
}

GaussianProcess compacted(GaussianProcess gp, const ConstMatrix& x) {
  if (gp.root.size() > 0) gp.root = lower_root(gp.root);
  GaussianProcess coarse = gp;
  coarse.weights = rounded(gp.weights);
  coarse.root = rounded(gp.root);
  return predicts_alike(gp, coarse, x) ? coarse : gp;
}

}  // namespace talkgraph
