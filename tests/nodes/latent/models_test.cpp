#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "nodes/latent/linear_models.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

/// Largest sine of the angles between two column spaces.
double distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const auto basis = [](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
    return m.householderQr().householderQ() * Eigen::MatrixXd::Identity(m.rows(), m.cols());
  };
  const Eigen::MatrixXd p = basis(a), q = basis(b);
  return (q - p * (p.transpose() * q)).norm();
}

TEST(Pcca, RecoversTheSubspaceItsDataWereDrawnFrom) {
  const Eigen::Index n = 20000;
  const auto x = gaussian(n, 2, 1), wy = gaussian(2, 6, 2), wz = gaussian(2, 5, 3);
  const Eigen::MatrixXd y = x * wy + 0.3 * gaussian(n, 6, 4), z = x * wz + 0.3 * gaussian(n, 5, 5);
  const Pcca model = fit_pcca(y, z, 2);
  EXPECT_LT(distance(model.loadings_y, wy.transpose()), 0.03);
  EXPECT_LT(distance(model.loadings_z, wz.transpose()), 0.03);
  const Eigen::MatrixXd latent = model.posterior_mean(y, z);
  const Eigen::MatrixXd fitted = latent * (latent.transpose() * latent).ldlt().solve(latent.transpose() * x);
  EXPECT_LT((fitted - x).squaredNorm() / x.squaredNorm(), 0.05);
}

TEST(Pcca, PosteriorMeanIsThatOfTheJointGaussian) {
  const Eigen::Index n = 200;
  const auto x = gaussian(n, 2, 1);
  const Eigen::MatrixXd y = x * gaussian(2, 4, 2) + gaussian(n, 4, 4), z = x * gaussian(2, 3, 3) + gaussian(n, 3, 5);
  const Pcca model = fit_pcca(y, z, 2, 0);
  const Eigen::MatrixXd a = y.rowwise() - model.mean_y, b = z.rowwise() - model.mean_z;
  Eigen::MatrixXd joint(7, 7), loadings(7, 2), both(n, 7);
  loadings << model.loadings_y, model.loadings_z;
  both << a, b;
  joint << a.transpose() * a / n, model.loadings_y * model.loadings_z.transpose(),
      model.loadings_z * model.loadings_y.transpose(), b.transpose() * b / n;
  EXPECT_TRUE(model.posterior_mean(y, z).isApprox(both * joint.inverse() * loadings, 1e-6));
}

TEST(Pcca, StaysFiniteOnDegenerateData) {
  for (const Eigen::Index n : {1, 2, 5}) {
    Eigen::MatrixXd y = gaussian(n, 8, 1), z = gaussian(n, 6, 2);
    y.col(3).setConstant(7);
    EXPECT_TRUE(fit_pcca(y, z, 7).posterior_mean(y, z).allFinite());
    EXPECT_TRUE(fit_pcca(y.setConstant(2), z.setConstant(1), 3).posterior_mean(y, z).isZero(1e-9));
  }
  EXPECT_THROW(fit_pcca(gaussian(3, 2, 1), gaussian(4, 2, 1), 1), std::runtime_error);
  EXPECT_THROW(fit_pcca(Eigen::MatrixXd(0, 2), Eigen::MatrixXd(0, 2), 1), std::runtime_error);
}

TEST(Ppca, RecoversSubspaceAndNoise) {
  const Eigen::Index n = 20000;
  const auto x = gaussian(n, 2, 1), w = gaussian(2, 6, 2);
  const Eigen::MatrixXd y = x * w + 0.5 * gaussian(n, 6, 4);
  const Ppca model = fit_ppca(y, 2);
  EXPECT_LT(distance(model.loadings, w.transpose()), 0.03);
  EXPECT_NEAR(model.noise, 0.25, 0.01);
  EXPECT_TRUE((model.loadings * model.loadings.transpose()).isApprox(w.transpose() * w, 0.05));
  EXPECT_TRUE(fit_ppca(y.topRows(1), 3).posterior_mean(y.topRows(1)).isZero(1e-9));
  EXPECT_TRUE(fit_ppca(y.topRows(3), 9).posterior_mean(y.topRows(3)).allFinite());
}

}  // namespace
}  // namespace talkgraph
