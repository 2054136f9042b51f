#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "nodes/latent/bayesian_objective.h"
#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/psi_statistics.h"
#include "nodes/latent/scg.h"
#include "tests/nodes/latent/textbook.h"

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

TEST(PsiStatistics, KeepTheirDigitsFarFromTheOrigin) {
  const Eigen::Index n = 12, m = 6, d = 3;
  const auto gradients_at = [&](double shift) {
    const Eigen::MatrixXd mean = 0.2 * gaussian(n, d, 1).array() + shift, u = 0.2 * gaussian(m, d, 2).array() + shift;
    const Eigen::MatrixXd variance = 0.01 * gaussian(n, d, 3).cwiseAbs2(), g2 = gaussian(m, m, 5);
    PsiStatistics psi;
    psi.begin({1, 0.1, Eigen::Vector3d(35, 60, 95)}, u);
    psi.first(mean, variance);
    Eigen::MatrixXd two = Eigen::MatrixXd::Zero(m, m), by_mean = Eigen::MatrixXd::Zero(n, d), by_variance = by_mean;
    psi.add_second(mean, variance, two);
    psi.gradient(gaussian(n, m, 4), g2 + g2.transpose(), mean, variance, by_mean, by_variance);
    Eigen::VectorXd all(2 * n * d + m * d + d);
    all << by_mean.reshaped(), by_variance.reshaped(), psi.inducing_gradient().reshaped(),
        psi.kernel_gradient().inverse_widths;
    return all;
  };
  const Eigen::VectorXd near = gradients_at(0), far = gradients_at(32);
  EXPECT_LT((far - near).cwiseAbs().maxCoeff(), 1e-9 * near.cwiseAbs().maxCoeff());
}

VariationalProcess process_of(Eigen::Index inducing, Eigen::Index d, std::uint64_t seed) {
  VariationalProcess process;
  process.kernel.variance = 1.2;
  process.kernel.inverse_widths = Eigen::VectorXd::LinSpaced(d, 0.8, 1.5);
  process.minimum_noise = 0.01;
  process.inducing = gaussian(inducing, d, seed);
  return process;
}

VariationalStream stream_of(const Eigen::MatrixXd& y, VariationalProcess process) {
  return {"audio", observed_outputs(y, OutputScaling::none, "audio"), std::move(process)};
}

double collapsed_bound(const Eigen::MatrixXd& y, const GaussianRows& q, const VariationalProcess& process) {
  VariationalStream stream = stream_of(y, process);
  stream.begin(process.parameters());
  Eigen::VectorXd unused;
  return stream.collapsed(q, nullptr, unused);
}

GaussianRows rows_of(Eigen::Index n, Eigen::Index d, std::uint64_t seed) {
  return {gaussian(n, d, seed), 0.3 * (0.5 * gaussian(n, d, seed + 1)).array().exp()};
}

Eigen::MatrixXd centred(Eigen::MatrixXd y) { return y.rowwise() - y.colwise().mean(); }

TEST(CollapsedBound, OfCertainInputsIsTitsiasBound) {
  const VariationalProcess process = process_of(5, 2, 1);
  const Eigen::MatrixXd y = centred(gaussian(12, 3, 2)), x = gaussian(12, 2, 3);
  const Kernel kernel{{ArdTerm{process.kernel.variance, process.kernel.inverse_widths}, BiasTerm{process.kernel.bias},
                       WhiteTerm{process.noise, process.minimum_noise}}};
  VariationalLikelihood sparse;
  const double expected = sparse.evaluate(kernel, x, process.inducing, y, nullptr);
  // The two differ by the bound's jitter of 1e-6.
  EXPECT_NEAR(collapsed_bound(y, {x, Eigen::MatrixXd::Zero(12, 2)}, process), expected, 1e-3);
  EXPECT_NEAR(collapsed_bound(y, {x, Eigen::MatrixXd::Constant(12, 2, 1e-9)}, process), expected, 1e-3);
  EXPECT_LE(expected, FullLikelihood().evaluate(kernel, x, process.inducing, y, nullptr));
}

TEST(CollapsedBound, OfMissingValuesIsThatOfEachOutputsOwnRows) {
  const VariationalProcess process = process_of(4, 2, 1);
  const GaussianRows q = rows_of(9, 2, 5);
  Eigen::MatrixXd y = gaussian(9, 3, 2);
  y(1, 0) = y(4, 0) = y(4, 2) = y(8, 1) = nan;
  double expected = 0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<Eigen::Index> there;
    for (Eigen::Index n = 0; n < 9; ++n)
      if (!std::isnan(y(n, c))) there.push_back(n);
    expected +=
        collapsed_bound(y(there, std::vector{c}), {q.mean(there, Eigen::all), q.variance(there, Eigen::all)}, process);
  }
  EXPECT_NEAR(collapsed_bound(y, q, process), expected, 1e-9);
}

TEST(CollapsedBound, TakesRowsInPartsOfAnySize) {
  VariationalProcess process = process_of(100, 2, 1);  // parts of 207 rows
  process.kernel.inverse_widths *= 30;
  const Eigen::MatrixXd y = gaussian(300, 3, 2);
  GaussianRows q = rows_of(300, 2, 5);
  VariationalStream stream = stream_of(y, process);
  const Eigen::VectorXd start = process.parameters();
  Cost cost(4, [&](const Eigen::VectorXd& p, Eigen::VectorXd* g) {
    q.mean(3, 0) = p[0];
    q.variance(299, 1) = p[1];
    Eigen::VectorXd at = start;
    at.head(2) = p.tail(2);
    stream.begin(at);
    GaussianRows by;
    by.set_zero(300, 2);
    Eigen::VectorXd by_parameters(start.size());
    const double value = stream.collapsed(q, g ? &by : nullptr, by_parameters);
    if (g) *g = Eigen::Vector4d(by.mean(3, 0), by.variance(299, 1), by_parameters[0], by_parameters[1]);
    return value;
  });
  EXPECT_LT(check_gradient(cost, Eigen::Vector4d(0.1, 0.5, start[0], start[1]), 1e-3).worst, 1e-6);
}

TEST(StochasticBound, WithTheBestInducingVariablesIsTheCollapsedOne) {
  for (const bool missing : {false, true}) {
    const VariationalProcess process = process_of(4, 2, 1);
    const GaussianRows q = rows_of(9, 2, 5);
    Eigen::MatrixXd y = gaussian(9, 3, 2);
    if (missing) y(1, 0) = y(4, 0) = y(4, 2) = nan;
    VariationalStream stream = stream_of(y, process);
    stream.begin(process.parameters());
    GaussianRows by, by_collapsed;
    by.set_zero(9, 2);
    by_collapsed.set_zero(9, 2);
    Eigen::VectorXd g(stream.size()), g_collapsed(stream.size());
    const double best = stream.collapsed(q, &by_collapsed, g_collapsed);
    stream.begin(process.parameters());
    EXPECT_NEAR(stream.stochastic(stream.outputs().classes, 1, 1, q, by, g), best, 1e-8);
    // There the derivative by the inducing variables is nought, so that the others agree.
    EXPECT_TRUE(g.isApprox(g_collapsed, 1e-6));
    EXPECT_TRUE(by.mean.isApprox(by_collapsed.mean, 1e-9));
    EXPECT_TRUE(by.variance.isApprox(by_collapsed.variance, 1e-9));
    stream.begin(0.9 * process.parameters());
    const double other = stream.stochastic(stream.outputs().classes, 1, 0, q, by, g);
    EXPECT_LT(other, stream.collapsed(q, nullptr, g));
  }
}

TEST(StochasticBound, GradientsAgreeWithDifferences) {
  const VariationalProcess process = process_of(4, 2, 1);
  Eigen::MatrixXd y = gaussian(9, 3, 2);
  y(1, 0) = y(4, 0) = y(4, 2) = nan;
  VariationalStream stream = stream_of(y, process);
  stream.begin(process.parameters());
  GaussianRows by;
  by.set_zero(9, 2);
  Eigen::VectorXd unused(stream.size());
  stream.stochastic(stream.outputs().classes, 1, 0.7, rows_of(9, 2, 5), by, unused);
  const auto classes = stream.classes_of({0, 1, 4, 7});
  Cost cost(stream.size() + 36, [&](const Eigen::VectorXd& p, Eigen::VectorXd* g) {
    const GaussianRows q{p.segment(stream.size(), 18).reshaped(9, 2), p.tail(18).array().exp().matrix().reshaped(9, 2)};
    stream.begin(p.head(stream.size()));
    by.set_zero(9, 2);
    Eigen::VectorXd by_process(stream.size());
    const double value = stream.stochastic(classes, 9 / 4.0, 0, q, by, by_process);
    if (g) {
      g->resize(p.size());
      *g << by_process, by.mean.reshaped(), by.variance.cwiseProduct(q.variance).reshaped();
    }
    return value;
  });
  Eigen::VectorXd start = gaussian(cost.n, 1, 8);
  start.head(stream.size()) = process.parameters();
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto check = check_gradient(cost, start + 0.2 * gaussian(cost.n, 1, seed), 1e-3);
    EXPECT_LT(check.worst, 1e-6) << seed << " at " << check.where;
  }
}

TEST(LatentPosterior, OverTimeIsTheDenseGaussian) {
  const LatentPosterior latents({3, 5}, 2);
  const Eigen::MatrixXd free = gaussian(8, 1, 1), log_precision = gaussian(8, 1, 2);
  GaussianRows q;
  q.set_zero(8, 1);
  const double divergence = latents.compute({0, 1}, free, log_precision, q.mean, q.variance);
  double expected = 0;
  for (const auto& [start, n] : {std::pair<Eigen::Index, Eigen::Index>{0, 3}, {3, 5}}) {
    Eigen::MatrixXd k(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        k(i, j) = i == j ? 1 : 0.95 * std::exp(-0.125 * static_cast<double>((i - j) * (i - j)));
    const Eigen::VectorXd precision = log_precision.col(0).segment(start, n).array().exp();
    const Eigen::MatrixXd inverse = k.inverse();
    const Eigen::MatrixXd s = (inverse + Eigen::MatrixXd(precision.asDiagonal())).inverse();
    const Eigen::VectorXd m = q.mean.col(0).segment(start, n);
    EXPECT_TRUE(q.variance.col(0).segment(start, n).isApprox(s.diagonal(), 1e-9));
    expected += 0.5 * ((inverse * s).trace() + m.dot(inverse * m) - static_cast<double>(n) +
                       std::log(k.determinant() / s.determinant()));
  }
  EXPECT_NEAR(divergence, expected, 1e-9);
  EXPECT_TRUE(latents.free_mean(q.mean).isApprox(free, 1e-9));
}

struct Setting {
  bool missing = false;
  double width = 0;
  int streams = 2;
};

BayesianObjective small_objective(const Setting& setting) {
  const Eigen::Index n = 8, d = 2;
  std::vector<VariationalStream> streams;
  for (int s = 0; s < setting.streams; ++s) {
    Eigen::MatrixXd y = gaussian(n, 3 + s, 10 + static_cast<std::uint64_t>(s));
    if (setting.missing) {
      y.row(2 + s).setConstant(nan);
      y(5, 1) = y(7, 1) = y(7, 2) = nan;
    }
    streams.emplace_back("stream", observed_outputs(y, OutputScaling::per_dimension, "stream"),
                         process_of(3, d, 20 + static_cast<std::uint64_t>(s)));
  }
  return {LatentPosterior({3, 1, 4}, setting.width), std::move(streams), gaussian(n, d, 30), 0.5};
}

TEST(BayesianObjective, GradientsAgreeWithDifferences) {
  for (const bool missing : {false, true})
    for (const double width : {0.0, 2.0})
      for (const int streams : {1, 2}) {
        BayesianObjective objective = small_objective({missing, width, streams});
        for (std::uint64_t seed = 0; seed < 100; ++seed) {
          const auto check =
              check_gradient(objective, objective.start() + 0.3 * gaussian(objective.size(), 1, seed), 3e-4);
          EXPECT_TRUE(check.evaluated && check.cost_consistent);
          EXPECT_LT(check.worst, 1e-6) << "missing " << missing << " width " << width << " streams " << streams
                                       << " at " << check.where;
        }
      }
}

/// Two frames in one latent dimension: their covariance hangs on x₁ − x₂ ~ N(0, 2) alone.
double exact_evidence(const Eigen::MatrixXd& y, const VariationalProcess& p) {
  const auto [nodes, weights] = gauss_hermite(200);
  const double width = p.kernel.inverse_widths[0], shared = p.kernel.bias;
  double sum = 0;
  for (Eigen::Index i = 0; i < nodes.size(); ++i) {
    Eigen::Matrix2d k;
    k.setConstant(p.kernel.variance * std::exp(-width * nodes[i] * nodes[i]) + shared);
    k.diagonal().setConstant(p.kernel.variance + shared + p.noise);
    sum += weights[i] * std::exp(testing::textbook_density(k, y));
  }
  return std::log(sum);
}

TEST(BayesianObjective, IsBelowTheEvidenceAndNearIt) {
  Eigen::MatrixXd y(2, 2);
  y << 0.9, -0.4, -0.9, 0.4;
  VariationalProcess process = process_of(6, 1, 3);
  process.noise = 0.5;
  process.kernel.inverse_widths[0] = 0.3;
  std::vector<VariationalStream> streams;
  streams.push_back(stream_of(y, process));
  BayesianObjective objective(LatentPosterior({1, 1}, 0), std::move(streams), gaussian(2, 1, 4), 0.5);
  const double evidence = exact_evidence(y, process);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Eigen::VectorXd p = objective.start();
    p.head(10) += gaussian(10, 1, seed);  // q(X) and inducing points
    EXPECT_LT(objective.value(p, nullptr), evidence);
  }
  // Only q(X) and the inducing points move, so that the evidence stays what it is.
  Cost held(10, [&](const Eigen::VectorXd& p, Eigen::VectorXd* g) {
    Eigen::VectorXd all = objective.start(), by;
    all.head(10) = p;
    const double value = -objective.value(all, g ? &by : nullptr);
    if (g) *g = -by.head(10);
    return value;
  });
  Eigen::VectorXd p = objective.start().head(10);
  ScaledConjugateGradients optimiser;
  optimiser.iterations = 200;
  const double reached = -optimiser.minimise(held, p).cost;
  EXPECT_LT(reached, evidence);
  EXPECT_GT(reached, evidence - 1);
}

}  // namespace
}  // namespace talkgraph
