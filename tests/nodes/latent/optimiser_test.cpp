#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <memory>
#include <numbers>
#include <thread>

#include "nodes/latent/lbfgs.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sgpdm_objective.h"
#include "tests/nodes/latent/gaussian.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::gaussian;

struct Rosenbrock : Objective {
  Eigen::Index size() const override { return 2; }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    const double a = 1 - p[0], b = p[1] - p[0] * p[0];
    cost = a * a + 100 * b * b;
    if (gradient) *gradient = Eigen::Vector2d(-2 * a - 400 * p[0] * b, 200 * b);
    return true;
  }
};

struct Quadratic : Objective {
  Eigen::MatrixXd root = gaussian(8, 8, 1);
  Eigen::VectorXd optimum = gaussian(8, 1, 2);
  Eigen::Index size() const override { return 8; }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    const Eigen::VectorXd r = root * (p - optimum);
    cost = 0.5 * r.squaredNorm();
    if (gradient) *gradient = root.transpose() * r;
    return true;
  }
};

/// Defined for positive numbers only; least at a thousandth.
struct HalfLine : Objective {
  Eigen::Index size() const override { return 1; }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    if (p[0] <= 0) return false;
    cost = p[0] - 1e-3 * std::log(p[0]);
    if (gradient) *gradient = Eigen::VectorXd::Constant(1, 1 - 1e-3 / p[0]);
    return true;
  }
};

enum class Kind { scg, lbfgs };
class Optimisers : public ::testing::TestWithParam<Kind> {
 protected:
  std::unique_ptr<Optimiser> optimiser(int iterations, double tolerance) const {
    std::unique_ptr<Optimiser> o;
    if (GetParam() == Kind::scg)
      o = std::make_unique<ScaledConjugateGradients>();
    else
      o = std::make_unique<Lbfgs>();
    o->iterations = iterations;
    o->step_tolerance = o->cost_tolerance = tolerance;
    return o;
  }
};
INSTANTIATE_TEST_SUITE_P(Latent, Optimisers, ::testing::Values(Kind::scg, Kind::lbfgs),
                         [](const auto& info) { return info.param == Kind::scg ? "scg" : "lbfgs"; });

TEST_P(Optimisers, FindTheMinimumOfRosenbrocksFunction) {
  Rosenbrock f;
  Eigen::VectorXd p = Eigen::Vector2d(-1.2, 1);
  const auto report = optimiser(1000, 1e-10)->minimise(f, p);
  EXPECT_NE(report.reason, StopReason::iterations);
  EXPECT_TRUE(p.isApprox(Eigen::Vector2d(1, 1), 1e-4)) << p.transpose();
}

TEST_P(Optimisers, SolveAQuadraticAndReport) {
  Quadratic f;
  Eigen::VectorXd p = Eigen::VectorXd::Zero(8), gradient;
  const auto report = optimiser(500, 1e-12)->minimise(f, p);
  EXPECT_TRUE(p.isApprox(f.optimum, 1e-3));
  EXPECT_LT(report.cost, 1e-8);
  EXPECT_GE(report.evaluations, report.iterations);
  double cost = 0;
  f.evaluate(p, cost, &gradient);
  EXPECT_EQ(cost, report.cost);
  EXPECT_EQ(gradient.lpNorm<Eigen::Infinity>(), report.gradient_norm);
  ASSERT_EQ(report.trace.size(), static_cast<std::size_t>(report.iterations) + 1);
  EXPECT_EQ(report.trace.back(), report.cost);
  EXPECT_TRUE(std::is_sorted(report.trace.rbegin(), report.trace.rend()));
}

TEST_P(Optimisers, KeepToTheirIterationLimit) {
  Rosenbrock f;
  for (const int limit : {0, 1, 7}) {
    Eigen::VectorXd p = Eigen::Vector2d(-1.2, 1);
    int told = 0;
    const auto o = optimiser(limit, 1e-4);
    o->on_iteration = [&](int i, double) { EXPECT_EQ(i, ++told); };
    const auto report = o->minimise(f, p);
    EXPECT_EQ(report.iterations, limit);
    EXPECT_EQ(told, limit);
    EXPECT_EQ(report.reason, StopReason::iterations);
    double cost = 0;
    f.evaluate(p, cost, nullptr);
    EXPECT_EQ(cost, report.cost);
  }
}

TEST_P(Optimisers, KeepToTheirTimeLimit) {
  Rosenbrock f;
  Eigen::VectorXd p = Eigen::Vector2d(-1.2, 1);
  const auto o = optimiser(1000000, 0);
  o->seconds = 0.02;
  o->on_iteration = [](int, double) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); };
  const auto report = o->minimise(f, p);
  EXPECT_EQ(report.reason, StopReason::time);
  EXPECT_LT(report.iterations, 10);
  EXPECT_GT(report.iterations, 0);
}

TEST_P(Optimisers, StepBackWhereTheCostCannotBeEvaluated) {
  HalfLine f;
  Eigen::VectorXd p = Eigen::VectorXd::Constant(1, 0.5);
  optimiser(100, 1e-9)->minimise(f, p);
  EXPECT_NEAR(p[0], 1e-3, 1e-5);
  p[0] = -1;
  EXPECT_EQ(optimiser(100, 1e-9)->minimise(f, p).reason, StopReason::failed);
  EXPECT_EQ(p[0], -1);
}

TEST_P(Optimisers, LeaveTheParametersToWhoStopsThem) {
  struct Stopped {};
  Rosenbrock f;
  const auto o = optimiser(100, 1e-9);
  o->on_iteration = [](int, double) { throw Stopped(); };
  const Eigen::VectorXd start = Eigen::Vector2d(-1.2, 1);
  Eigen::VectorXd p = start;
  EXPECT_THROW(o->minimise(f, p), Stopped);
  EXPECT_EQ(p, start);
}

TEST_P(Optimisers, SayThatTheGradientVanishedAtTheMinimum) {
  Quadratic f;
  Eigen::VectorXd p = f.optimum;
  EXPECT_EQ(optimiser(100, 1e-9)->minimise(f, p).reason, StopReason::flat);
}

/// One cost whatever the parameters.
struct Constant : Objective {
  Eigen::Index count;
  double cost;
  Constant(Eigen::Index count, double cost) : count(count), cost(cost) {}
  Eigen::Index size() const override { return count; }
  bool evaluate(const Eigen::VectorXd& p, double& value, Eigen::VectorXd* gradient) override {
    value = cost;
    if (gradient) *gradient = Eigen::VectorXd::Zero(p.size());
    return true;
  }
};

TEST_P(Optimisers, GiveTheSameReasonsWhereThereIsNothingToDo) {
  const auto reason = [&](Eigen::Index count, double cost, int iterations) {
    Constant f(count, cost);
    Eigen::VectorXd p = Eigen::VectorXd::Ones(count);
    return optimiser(iterations, 1e-9)->minimise(f, p).reason;
  };
  EXPECT_EQ(reason(2, std::nan(""), 10), StopReason::failed);
  EXPECT_EQ(reason(2, 1, 10), StopReason::flat);
  EXPECT_EQ(reason(0, 1, 10), StopReason::flat);
  EXPECT_EQ(reason(0, 1, 0), StopReason::iterations);
}

TEST_P(Optimisers, GoOnFromAStateOnDisk) {
  struct Killed {};
  Rosenbrock f;
  const auto whole_run = optimiser(12, 1e-10);
  OptimiserState whole, cut, resumed;
  whole.parameters = cut.parameters = Eigen::Vector2d(-1.2, 1);
  whole_run->minimise(f, whole);
  const auto killed = optimiser(12, 1e-10);
  killed->on_iteration = [](int i, double) {
    if (i == 5) throw Killed();
  };
  EXPECT_THROW(killed->minimise(f, cut), Killed);
  const test::TemporaryFolder folder;
  write_hdf5(folder.file("state.h5"), [&](Archive& ar) { fields(ar, cut); });
  fields(*hdf5_reader(folder.file("state.h5")), resumed);
  EXPECT_EQ(resumed.report.iterations, 5);
  whole_run->minimise(f, resumed);
  EXPECT_EQ(resumed.report.iterations, 12);
  EXPECT_EQ(resumed.report.trace.size(), 13u);
  EXPECT_TRUE(std::is_sorted(resumed.report.trace.rbegin(), resumed.report.trace.rend()));
  if (GetParam() == Kind::scg) {
    EXPECT_EQ(resumed.parameters, whole.parameters);
    EXPECT_EQ(resumed.report.trace, whole.report.trace);
  }
}

TEST_P(Optimisers, GoOnFromAnyIterationToTheSameEnd) {
  Rosenbrock f;
  const Eigen::VectorXd start = Eigen::Vector2d(-1.2, 1);
  OptimiserState whole;
  whole.parameters = start;
  optimiser(2000, 1e-6)->minimise(f, whole);
  ASSERT_EQ(whole.report.reason, StopReason::converged);
  struct Killed {};
  for (int stop = 1; stop <= whole.report.iterations; ++stop) {
    OptimiserState state;
    state.parameters = start;
    const auto killed = optimiser(2000, 1e-6);
    killed->on_iteration = [&](int i, double) {
      if (i == stop) throw Killed();
    };
    EXPECT_THROW(killed->minimise(f, state), Killed);
    optimiser(2000, 1e-6)->minimise(f, state);
    EXPECT_EQ(state.report.reason, StopReason::converged);
    if (GetParam() == Kind::lbfgs && stop < whole.report.iterations) continue;  // the memory of its steps is lost
    EXPECT_EQ(state.parameters, whole.parameters) << "stopped after " << stop;
    EXPECT_EQ(state.report.trace, whole.report.trace) << "stopped after " << stop;
  }
}

/// GPLVM with kernel x·x' + noise: its optimum is dual PPCA.
TEST_P(Optimisers, ReachTheClosedFormOfPpca) {
  const Eigen::Index n = 12, dims = 30, d = 2;
  const Eigen::MatrixXd y = 1.5 * gaussian(n, d, 1) * gaussian(d, dims, 2) + 0.4 * gaussian(n, dims, 3);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(y * y.transpose() / static_cast<double>(dims));
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double noise = values.head(n - d).mean();
  const double optimum = -0.5 * static_cast<double>(dims) *
                         (static_cast<double>(n) * (std::log(2 * std::numbers::pi) + 1) +
                          values.tail(d).array().log().sum() + static_cast<double>(n - d) * std::log(noise));

  SgpdmProblem problem;
  GpStream process{"y", {{LinearTerm{1}, WhiteTerm{0.5, 0}}}, Eigen::MatrixXd(0, d), nullptr, 1};
  process.likelihood = std::make_unique<FullLikelihood>();
  problem.observations.push_back({std::move(process), y, Eigen::RowVectorXd::Ones(dims)});
  problem.lengths = {n};
  problem.latents = 0.3 * gaussian(n, d, 4);
  problem.dynamics_weight = 0;
  problem.fixed = {"y.linear"};
  SgpdmObjective objective(std::move(problem));
  Eigen::VectorXd p = objective.start();
  const auto report = optimiser(3000, 1e-9)->minimise(objective, p);
  EXPECT_NEAR(-report.cost, optimum, 1e-6 * std::abs(optimum)) << str(report.reason);
  EXPECT_NEAR(white_variance(objective.process(0, p).kernel), noise, 1e-4 * noise);
  const Eigen::MatrixXd x = objective.latents(p), top = eigen.eigenvectors().rightCols(d);
  const Eigen::VectorXd kept = values.tail(d).array() - noise;
  EXPECT_TRUE((x * x.transpose()).isApprox(top * kept.asDiagonal() * top.transpose(), 1e-3));
}

}  // namespace
}  // namespace talkgraph
