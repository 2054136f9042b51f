#include "nodes/speech/levinson.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace talkgraph {
namespace {

LinearPrediction predictor(const Eigen::VectorXd& r) {
  LinearPrediction p;
  levinson(r, p);
  return p;
}

/// The normal equations Σ_k a_k r_|i-k| = r_i, solved as they stand.
Eigen::VectorXd solved(const Eigen::VectorXd& r) {
  const auto order = r.size() - 1;
  Eigen::MatrixXd matrix(order, order);
  for (Eigen::Index i = 0; i < order; ++i)
    for (Eigen::Index j = 0; j < order; ++j) matrix(i, j) = r[std::abs(i - j)];
  return matrix.partialPivLu().solve(r.tail(order));
}

Eigen::VectorXd autocorrelation(const Eigen::VectorXd& x, int order) {
  Eigen::VectorXd r(order + 1);
  for (int m = 0; m <= order; ++m) r[m] = x.head(x.size() - m).dot(x.tail(x.size() - m));
  return r;
}

double largest_root(const Eigen::VectorXd& a) {
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(a.size(), a.size());
  companion.row(0) = a.transpose();
  companion.diagonal(-1).setOnes();
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(Levinson, SolvesTheNormalEquations) {
  srand(1);
  for (const int order : {1, 2, 7, 20}) {
    const Eigen::VectorXd r = autocorrelation(Eigen::VectorXd::Random(400), order);
    const LinearPrediction p = predictor(r);
    const Eigen::VectorXd a = solved(r);
    EXPECT_LT((p.a - a).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_NEAR(p.error, r[0] - a.dot(r.tail(order)), 1e-12 * r[0]);
    for (int m = 1; m <= order; ++m) EXPECT_NEAR(p.reflection[m - 1], solved(r.head(m + 1))[m - 1], 1e-13) << m;
  }
}

TEST(Levinson, GivesBackTheFilterOfAnAutoregressiveProcess) {
  // r_m of x[t] = 0.9 x[t-1] + e is 0.9^m; orders above the first find nothing more.
  Eigen::VectorXd r(5);
  for (int m = 0; m < 5; ++m) r[m] = 3 * std::pow(0.9, m);
  const LinearPrediction p = predictor(r);
  EXPECT_NEAR(p.a[0], 0.9, 1e-15);
  EXPECT_LT(p.a.tail(3).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(p.error, 3 * (1 - 0.81), 1e-14);
}

TEST(Levinson, IsZeroForSilence) {
  for (const double r0 : {0.0, -1.0}) {
    const LinearPrediction p = predictor(r0 * Eigen::VectorXd::Ones(21));
    EXPECT_TRUE(p.a.isZero(0));
    EXPECT_TRUE(p.reflection.isZero(0));
    EXPECT_EQ(p.error, 0);
  }
}

TEST(Levinson, IsStableWhereNothingIsLeftToPredict) {
  Eigen::VectorXd r(21);
  for (const double frequency : {0.0, 0.01, 0.7, 3.14159}) {  // an endless sine is predicted by two samples
    for (int m = 0; m <= 20; ++m) r[m] = std::cos(frequency * m);
    const LinearPrediction p = predictor(r);
    EXPECT_TRUE(p.a.allFinite());
    EXPECT_LT(p.reflection.cwiseAbs().maxCoeff(), 1);
    EXPECT_GE(p.error, 0);
    EXPECT_LT(largest_root(p.a), 1 + 1e-6) << frequency;
  }
  // Not an autocorrelation at all.
  r.setConstant(1);
  r[3] = 5;
  EXPECT_TRUE(predictor(r).a.allFinite());
  EXPECT_LT(predictor(r).reflection.cwiseAbs().maxCoeff(), 1);
}

TEST(Levinson, WritesOverWhatWasThere) {
  LinearPrediction p;
  levinson(autocorrelation(Eigen::VectorXd::Random(400), 20), p);
  levinson(Eigen::VectorXd::Zero(5), p);
  EXPECT_EQ(p.a.size(), 4);
  EXPECT_TRUE(p.a.isZero(0));
}

}  // namespace
}  // namespace talkgraph
