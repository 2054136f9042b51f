#include "nodes/latent/compact.h"

#include <Eigen/QR>
#include <bit>
#include <cstdint>

#include "nodes/latent/predictive.h"

namespace talkgraph {

namespace {

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

Eigen::MatrixXd rounded(const Eigen::MatrixXd& m, int bits) {
  const std::uint64_t place = std::uint64_t{1} << (52 - bits);
  return m.unaryExpr([place](double v) {
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(v) + place / 2) & ~(place - 1));
  });
}

GaussianProcess compacted(GaussianProcess gp, const ConstMatrix& x) {
  if (gp.root.size() > 0) gp.root = lower_root(gp.root);
  GaussianProcess coarse = gp;
  for (const int bits : {16, 20}) {
    coarse.weights = rounded(gp.weights, bits);
    coarse.root = rounded(gp.root, bits);
    if (predicts_alike(gp, coarse, x)) return coarse;
  }
  return gp;
}

}  // namespace talkgraph
