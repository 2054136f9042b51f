#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "nodes/latent/bayesian_objective.h"
#include "nodes/latent/psi_statistics.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A cost of which a function gives value and gradient.
struct Cost : Objective {
  Eigen::Index n;
  std::function<double(const Eigen::VectorXd&, Eigen::VectorXd*)> f;
  Cost(Eigen::Index n, std::function<double(const Eigen::VectorXd&, Eigen::VectorXd*)> f) : n(n), f(std::move(f)) {}
  Eigen::Index size() const override { return n; }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* g) override {
    cost = f(p, g);
    return true;
  }
};

/// Nodes and weights of Gauss-Hermite quadrature for N(0, 1), by the eigenvalues of the Jacobi matrix.
std::pair<Eigen::VectorXd, Eigen::VectorXd> gauss_hermite(Eigen::Index n) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 1; i < n; ++i) jacobi(i, i - 1) = jacobi(i - 1, i) = std::sqrt(static_cast<double>(i));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(jacobi);
  return {eigen.eigenvalues(), eigen.eigenvectors().row(0).array().square().transpose()};
}

double ard(const ArdKernel& k, const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  return k.variance * std::exp(-0.5 * ((a - b).array().square().matrix() * k.inverse_widths)[0]) + k.bias;
}

struct Psi {
  Eigen::MatrixXd one, two;
};

Psi psi_of(const ArdKernel& kernel, const Eigen::MatrixXd& u, const Eigen::MatrixXd& mean,
           const Eigen::MatrixXd& variance) {
  PsiStatistics psi;
  psi.begin(kernel, u);
  Psi all{psi.first(mean, variance), Eigen::MatrixXd::Zero(u.rows(), u.rows())};
  psi.add_second(mean, variance, all.two);
  return all;
}

TEST(PsiStatistics, AgreeWithQuadrature) {
  const auto [nodes, weights] = gauss_hermite(100);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const ArdKernel kernel{std::exp(0.3 * gaussian(1, 1, seed)(0)), 0.2,
                           (0.5 * gaussian(2, 1, seed + 100)).array().exp()};
    const Eigen::MatrixXd u = gaussian(4, 2, seed + 200), mean = gaussian(3, 2, seed + 300);
    const Eigen::MatrixXd variance = 0.4 * (0.5 * gaussian(3, 2, seed + 400)).array().exp();
    Psi expected{Eigen::MatrixXd::Zero(3, 4), Eigen::MatrixXd::Zero(4, 4)};
    for (Eigen::Index n = 0; n < 3; ++n)
      for (Eigen::Index a = 0; a < nodes.size(); ++a)
        for (Eigen::Index b = 0; b < nodes.size(); ++b) {
          Eigen::RowVector2d x(nodes[a], nodes[b]);
          x = mean.row(n).array() + x.array() * variance.row(n).array().sqrt();
          Eigen::VectorXd k(4);
          for (Eigen::Index i = 0; i < 4; ++i) k[i] = ard(kernel, x, u.row(i));
          expected.one.row(n) += weights[a] * weights[b] * k.transpose();
          expected.two += weights[a] * weights[b] * k * k.transpose();
        }
    const Psi psi = psi_of(kernel, u, mean, variance);
    EXPECT_LT((psi.one - expected.one).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT((psi.two - expected.two).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(PsiStatistics, OfCertainInputsAreTheKernel) {
  const ArdKernel kernel{1.3, 0.2, Eigen::Vector3d(0.7, 0, 2)};
  const Eigen::MatrixXd u = gaussian(4, 3, 1), x = gaussian(5, 3, 2);
  const Psi psi = psi_of(kernel, u, x, Eigen::MatrixXd::Zero(5, 3));
  for (Eigen::Index n = 0; n < 5; ++n)
    for (Eigen::Index i = 0; i < 4; ++i) EXPECT_NEAR(psi.one(n, i), ard(kernel, x.row(n), u.row(i)), 1e-14);
  EXPECT_LT((psi.two - psi.one.transpose() * psi.one).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(PsiStatistics, GradientsAgreeWithDifferences) {
  const Eigen::Index n = 4, m = 3, d = 2;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Eigen::MatrixXd g1 = gaussian(n, m, seed + 1000);
    Eigen::MatrixXd g2 = gaussian(m, m, seed + 2000);
    g2 = (0.5 * (g2 + g2.transpose())).eval();
    Cost cost(2 * n * d + m * d + 2 + d, [&](const Eigen::VectorXd& p, Eigen::VectorXd* g) {
      const Eigen::MatrixXd mean = p.head(n * d).reshaped(n, d);
      const Eigen::MatrixXd variance = p.segment(n * d, n * d).array().exp().matrix().reshaped(n, d);
      const Eigen::MatrixXd u = p.segment(2 * n * d, m * d).reshaped(m, d);
      const Eigen::VectorXd rest = p.tail(2 + d).array().exp();
      const ArdKernel kernel{rest[0], rest[1], rest.tail(d)};
      PsiStatistics psi;
      psi.begin(kernel, u);
      const Eigen::MatrixXd one = psi.first(mean, variance);
      Eigen::MatrixXd two = Eigen::MatrixXd::Zero(m, m);
      psi.add_second(mean, variance, two);
      if (g) {
        Eigen::MatrixXd by_mean = Eigen::MatrixXd::Zero(n, d), by_variance = by_mean;
        psi.gradient(g1, g2, mean, variance, by_mean, by_variance);
        const ArdKernel by = psi.kernel_gradient();
        g->resize(p.size());
        *g << by_mean.reshaped(), by_variance.cwiseProduct(variance).reshaped(), psi.inducing_gradient().reshaped(),
            by.variance * rest[0], by.bias * rest[1], by.inverse_widths.cwiseProduct(rest.tail(d));
      }
      return g1.cwiseProduct(one).sum() + g2.cwiseProduct(two).sum();
    });
    const auto check = check_gradient(cost, 0.7 * gaussian(cost.n, 1, seed), 1e-3);
    EXPECT_TRUE(check.cost_consistent);
    EXPECT_LT(check.worst, 1e-6) << seed << " at " << check.where;
  }
}

struct Setting {
  bool missing = false;
  double width = 0;
  int streams = 2;
  double log_precision = 0;
};

BayesianObjective small_objective(const Setting& setting) {
  const Eigen::Index n = 9, d = 2;
  std::vector<VariationalStream> streams;
  for (int s = 0; s < setting.streams; ++s) {
    Eigen::MatrixXd y = gaussian(n, 3 + s, 10 + static_cast<std::uint64_t>(s));
    if (setting.missing) {
      y.row(2 + s).setConstant(nan);
      y(5, 1) = y(7, 1) = y(7, 2) = nan;
    }
    VariationalProcess process;
    process.kernel.variance = 1.2;
    process.kernel.inverse_widths = Eigen::Vector2d(0.8, 1.5);
    process.minimum_noise = 0.01;
    process.inducing = gaussian(4, d, 20 + static_cast<std::uint64_t>(s));
    streams.emplace_back("stream", observed_outputs(y, OutputScaling::per_dimension, "first"), std::move(process));
  }
  return {LatentPosterior({4, 1, 4}, setting.width), std::move(streams), gaussian(n, d, 30), 0.5};
}

TEST(BayesianObjective, GradientsAgreeWithDifferences) {
  for (const bool missing : {false, true})
    for (const double width : {0.0, 2.0})
      for (const int streams : {1, 2}) {
        BayesianObjective objective = small_objective({missing, width, streams});
        for (std::uint64_t seed = 0; seed < 100; ++seed) {
          const auto check =
              check_gradient(objective, objective.start() + 0.3 * gaussian(objective.size(), 1, seed), 1e-3);
          EXPECT_TRUE(check.evaluated && check.cost_consistent);
          EXPECT_LT(check.worst, 1e-6) << "missing " << missing << " width " << width << " streams " << streams
                                       << " at " << check.where;
        }
      }
}

}  // namespace
}  // namespace talkgraph
