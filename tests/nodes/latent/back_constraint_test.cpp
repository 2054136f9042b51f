#include "nodes/latent/back_constraint.h"

#include <gtest/gtest.h>

#include "nodes/latent/objective.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

TEST(BackConstraint, OfAPerceptronIsItsFormula) {
  const HiddenUnits units{gaussian(3, 4, 1), gaussian(1, 4, 2)};
  const BackConstraint b{units, gaussian(4, 2, 3), gaussian(1, 2, 4)};
  const auto y = gaussian(5, 3, 5);
  const Eigen::MatrixXd x = latent_points(b, y);
  for (Eigen::Index t = 0; t < 5; ++t)
    for (Eigen::Index c = 0; c < 2; ++c) {
      double expected = b.bias[c];
      for (Eigen::Index h = 0; h < 4; ++h)
        expected += b.weights(h, c) * std::tanh(y.row(t).dot(units.weights.col(h)) + units.bias[h]);
      EXPECT_NEAR(x(t, c), expected, 1e-14);
    }
}

TEST(BackConstraint, OfKernelRegressionIsItsFormula) {
  const RbfUnits units{gaussian(6, 3, 1), Eigen::RowVector3d(0.5, 2, 0.1)};
  const BackConstraint b{units, gaussian(6, 2, 3), gaussian(1, 2, 4)};
  const auto y = gaussian(5, 3, 5);
  const Eigen::MatrixXd x = latent_points(b, y);
  for (Eigen::Index t = 0; t < 5; ++t) {
    Eigen::RowVectorXd expected = b.bias;
    for (Eigen::Index k = 0; k < 6; ++k) {
      const Eigen::RowVectorXd apart = y.row(t) - units.centres.row(k);
      expected += b.weights.row(k) * std::exp(-0.5 * apart.cwiseAbs2().dot(units.inverse_widths));
    }
    EXPECT_TRUE(x.row(t).isApprox(expected, 1e-13));
  }
}

TEST(BackConstraint, StartsNearTheLatentPointsItIsToGive) {
  const auto y = gaussian(40, 3, 1);
  const Eigen::MatrixXd x = (y * gaussian(3, 2, 2)).array().sin();
  const auto error = [&](const BackConstraint& b) { return (latent_points(b, y) - x).squaredNorm() / x.squaredNorm(); };
  EXPECT_LT(error(perceptron(y, x, 30)), 0.05);
  EXPECT_LT(error(kernel_regression(y, x, 1)), 0.01);
  EXPECT_LT(error(kernel_regression(y, x, 1000)), 0.01);
}

TEST(BackConstraint, OfRescaledFramesIsTheSameFunction) {
  const auto y = gaussian(10, 3, 1), x = gaussian(10, 2, 2);
  const Eigen::RowVectorXd ratio = Eigen::RowVector3d(0.5, 2, 3);
  for (const auto& b : {perceptron(y, x, 5), kernel_regression(y, x, 0.7)})
    EXPECT_TRUE(
        latent_points(of_rescaled(b, ratio), y.array().rowwise() / ratio.array()).isApprox(latent_points(b, y), 1e-12));
}

/// A weighted sum of latent points as a function of θ.
struct Probe : Objective {
  BackProjection b;
  Eigen::MatrixXd weights = gaussian(10, 2, 9);
  explicit Probe(BackProjection projection) : b(std::move(projection)) {}
  Eigen::Index size() const override { return b.size(); }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    cost = b.compute(p).cwiseProduct(weights).sum();
    if (!gradient) return true;
    gradient->resize(size());
    b.gradient(weights, *gradient);
    return true;
  }
};

TEST(BackProjection, GradientsAgreeWithDifferencesAndValuesWithTheFunction) {
  const auto y = gaussian(10, 3, 1), x = gaussian(10, 2, 2);
  for (const auto& start : {perceptron(y, x, 5), kernel_regression(y, x, 0.7)})
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      Probe probe(BackProjection(start, y));
      const Eigen::VectorXd p = probe.b.parameters() + gaussian(probe.size(), 1, seed);
      const auto check = check_gradient(probe, p);
      EXPECT_TRUE(check.evaluated && check.cost_consistent);
      EXPECT_LT(check.worst, 1e-8) << "parameter " << check.where;
      EXPECT_TRUE(latent_points(probe.b.with(p), y).isApprox(probe.b.compute(p), 1e-13));
    }
}

}  // namespace
}  // namespace talkgraph
