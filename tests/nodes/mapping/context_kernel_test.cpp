#include "nodes/mapping/context_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "nodes/latent/cholesky.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

constexpr Eigen::Index dimension = 4;

/// Some frames, three places of a window about each.
KernelExample example(Eigen::Index frames, int seed) {
  KernelExample e;
  for (int l = 0; l < 3; ++l) e.around.push_back(gaussian(frames, dimension, seed + l));
  e.targets = gaussian(frames, 2, seed + 3);
  e.counts = Eigen::VectorXd::Ones(frames);
  e.counts[0] = 0;
  return e;
}

std::vector<KernelExample> examples() { return {example(5, 10), example(3, 20), example(6, 30)}; }

ContextKernel kernel() {
  ContextKernel k{Eigen::RowVector3d(0.2, 0.5, 0.3), gaussian(dimension, dimension, 40), 0.7};
  k.map *= 0.4;
  return k;
}

double covariance(const KernelExample& a, Eigen::Index i, const KernelExample& b, Eigen::Index j,
                  const ContextKernel& k) {
  double distance = 0;
  for (std::size_t l = 0; l < a.around.size(); ++l)
    distance +=
        k.window[static_cast<Eigen::Index>(l)] * ((a.around[l].row(i) - b.around[l].row(j)) * k.map).squaredNorm();
  return std::exp(-distance);
}

Eigen::MatrixXd covariance(const KernelExample& a, const KernelExample& b, const ContextKernel& k) {
  return Eigen::MatrixXd::NullaryExpr(a.targets.rows(), b.targets.rows(),
                                      [&](Eigen::Index i, Eigen::Index j) { return covariance(a, i, b, j, k); });
}

/// The others learnt anew for each utterance.
double left_out_by_hand(const std::vector<KernelExample>& all, const ContextKernel& k) {
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(2);
  double frames = 0, squares = 0, counted = 0;
  for (const auto& e : all) mean += e.targets.colwise().sum(), frames += static_cast<double>(e.targets.rows());
  mean /= frames;
  for (std::size_t u = 0; u < all.size(); ++u) {
    const auto& a = all[(u + 1) % 3];
    const auto& b = all[(u + 2) % 3];
    const Eigen::Index n = a.targets.rows(), m = b.targets.rows();
    Eigen::MatrixXd others(n + m, n + m), targets(n + m, 2), with(all[u].targets.rows(), n + m);
    others << covariance(a, a, k), covariance(a, b, k), covariance(b, a, k), covariance(b, b, k);
    others.diagonal().array() += k.noise;
    targets << a.targets, b.targets;
    with << covariance(all[u], a, k), covariance(all[u], b, k);
    const Eigen::MatrixXd predicted = (with * others.fullPivLu().solve(targets.rowwise() - mean)).rowwise() + mean;
    const Eigen::MatrixXd error = all[u].counts.asDiagonal() * (all[u].targets - predicted);
    squares += error.squaredNorm(), counted += all[u].counts.sum();
  }
  return squares / (2 * counted);
}

LeftOutError error_of(const std::vector<KernelExample>& all, const ContextKernel& k) {
  std::vector<const KernelExample*> utterances;
  for (const auto& e : all) utterances.push_back(&e);
  return left_out_error(utterances, k);
}

TEST(LeftOutError, IsThatOfLearningAnewFromTheOthers) {
  EXPECT_NEAR(error_of(examples(), kernel()).value, left_out_by_hand(examples(), kernel()), 1e-10);
}

TEST(LeftOutError, HasTheDerivativesOfFiniteDifferences) {
  const auto all = examples();
  const auto gradient = error_of(all, kernel()).gradient;
  const auto difference = [&](const auto& change) {
    constexpr double step = 1e-5;
    ContextKernel more = kernel(), less = kernel();
    change(more, step), change(less, -step);
    return (error_of(all, more).value - error_of(all, less).value) / (2 * step);
  };
  for (Eigen::Index l = 0; l < 3; ++l)
    EXPECT_NEAR(gradient.window[l], difference([l](ContextKernel& k, double s) { k.window[l] *= std::exp(s); }), 1e-8);
  for (Eigen::Index i = 0; i < dimension; ++i)
    for (Eigen::Index j = 0; j < dimension; ++j)
      EXPECT_NEAR(gradient.map(i, j), difference([i, j](ContextKernel& k, double s) { k.map(i, j) += s; }), 1e-8);
  EXPECT_NEAR(gradient.noise, difference([](ContextKernel& k, double s) { k.noise *= std::exp(s); }), 1e-8);
}

TEST(LeftOutError, OfAPlaceWithoutWeightIsFinite) {
  auto k = kernel();
  k.window[1] = 0;
  const auto [value, gradient] = error_of(examples(), k);
  EXPECT_TRUE(std::isfinite(value));
  EXPECT_TRUE(gradient.map.allFinite());
  EXPECT_EQ(gradient.window[1], 0);
}

TEST(LeftOutError, SaysWhereNothingCanBeFactorised) {
  auto all = examples();
  all[1] = all[0];
  auto k = kernel();
  k.noise = -1;
  EXPECT_THROW(error_of(all, k), FactorisationError);
}

/// Only the first dimension at the middle place says anything, of twelve; the third and fourth belong to another group.
std::vector<KernelExample> one_that_tells(int utterances) {
  std::vector<KernelExample> all;
  for (int u = 0; u < utterances; ++u) {
    KernelExample e = example(20, 100 + 10 * u);
    e.counts.setOnes();
    e.targets = (2 * e.around[1].col(0).array()).sin();
    all.push_back(std::move(e));
  }
  return all;
}

TEST(LearnKernel, FindsWhatTells) {
  const auto all = one_that_tells(8);
  const ContextKernel start{Eigen::RowVector3d::Constant(1 / 3.0), Eigen::MatrixXd::Identity(dimension, dimension), 1};
  Context context;
  Random random(1), again(1), other(2);
  const auto learnt = learn_kernel({60, 5}, all, start, {2}, random, context);
  EXPECT_LT(error_of(all, learnt).value, 0.5 * error_of(all, start).value);
  EXPECT_GT(learnt.window[1], 2 * learnt.window[0]);
  EXPECT_GT(learnt.window[1], 2 * learnt.window[2]);
  const Eigen::VectorXd weights = learnt.map.rowwise().norm();
  EXPECT_GT(weights[0], 2 * weights.tail(3).maxCoeff());
  EXPECT_LT(learnt.noise, start.noise);
  EXPECT_TRUE(learnt.map.topRightCorner(2, 2).isZero());
  EXPECT_TRUE(learnt.map.bottomLeftCorner(2, 2).isZero());
  const Eigen::MatrixXd of_three = learn_kernel({10, 5}, all, start, {2, 1}, random, context).map;
  EXPECT_EQ(of_three(2, 3), 0);
  EXPECT_EQ(of_three(3, 2), 0);
  EXPECT_NE(of_three(0, 1), 0);
  EXPECT_EQ(learn_kernel({60, 5}, all, start, {2}, again, context).map, learnt.map);
  EXPECT_NE(learn_kernel({60, 5}, all, start, {2}, other, context).map, learnt.map);
}

TEST(LearnKernel, LeavesAsideWhatIsNoFeature) {
  auto all = one_that_tells(3);
  for (auto& e : all)
    for (auto& x : e.around) x.col(1).setZero();
  const ContextKernel start{Eigen::RowVector3d::Constant(1 / 3.0), Eigen::MatrixXd::Identity(dimension, dimension), 1};
  Context context;
  Random random(1);
  const auto learnt = learn_kernel({10, 60}, all, start, {2}, random, context);
  EXPECT_EQ(learnt.map.row(1), start.map.row(1));
  EXPECT_TRUE(learnt.map.allFinite());
}

}  // namespace
}  // namespace talkgraph
