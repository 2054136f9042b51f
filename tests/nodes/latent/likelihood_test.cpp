#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <thread>

#include "nodes/latent/predictive.h"
#include "tests/nodes/latent/likelihoods.h"

namespace talkgraph {
namespace {

using testing::approximations;
using testing::gaussian;
using testing::kernels;
using testing::LikelihoodCost;

const Kernel observation{{RbfTerm{1.3, 0.7}, BiasTerm{0.2}, WhiteTerm{0.1, 0.02}}};
const std::vector<Eigen::Index> blocks{4, 1, 3};

/// Inducing points far enough apart: of ten draws the one whose k(U, U) is conditioned best.
Eigen::MatrixXd apart(const Kernel& kernel, Eigen::Index k, std::uint64_t seed) {
  Eigen::MatrixXd best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint64_t draw = 0; draw < 10; ++draw) {
    const Eigen::MatrixXd u = 2 * gaussian(k, 2, 10 * seed + draw);
    const double condition = 1 / testing::textbook_matrix(kernel, u, u).partialPivLu().rcond();
    if (condition < least) best = u;
    least = std::min(least, condition);
  }
  return best;
}

TEST(Likelihood, IsTheTextbookDensityOfEveryKernelAndApproximation) {
  const std::vector<Eigen::Index> long_blocks{20, 7, 30, 13, 50, 20};
  for (const auto& approximation : approximations(long_blocks))
    for (const auto& [name, kernel, inducing] : kernels()) {
      const auto likelihood = approximation.make();
      double worst = 0;
      for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const auto x = gaussian(140, 2, 10 + seed), y = gaussian(140, 3, 20 + seed),
                   u = apart(kernel, inducing, 30 + seed);
        const double expected = approximation.textbook(kernel, x, u, y);
        const double value = likelihood->evaluate(kernel, x, u, y, nullptr);
        worst = std::max(worst, std::abs(value - expected) / std::max(1.0, std::abs(expected)));
      }
      EXPECT_LT(worst, 1e-9) << approximation.name << ", " << name;
      EXPECT_EQ(likelihood->jitter(), 0) << approximation.name << ", " << name;
      RecordProperty(approximation.name + ", " + name, fmt::format("{:.1e}", worst));
    }
}

TEST(Likelihood, GradientsAgreeWithDifferencesForEveryKernelAndApproximation) {
  for (const auto& approximation : approximations(blocks))
    for (const auto& [name, kernel, inducing] : kernels()) {
      const auto likelihood = approximation.make();
      double worst = 0;
      for (std::uint64_t seed = 0; seed < 100; ++seed) {
        LikelihoodCost cost(*likelihood, kernel, 8, 2, inducing, 3);
        Eigen::VectorXd p = gaussian(cost.size(), 1, 1000 + seed);
        p.segment(16, 2 * inducing) = apart(kernel, inducing, 2000 + seed).reshaped();
        const Eigen::Index parameters = parameter_count(kernel);
        p.tail(parameters) = log_parameters(kernel) + 0.3 * p.tail(parameters);
        const GradientCheck check = check_gradient(cost, p);
        ASSERT_TRUE(check.evaluated && check.cost_consistent);
        ASSERT_LT(check.worst, 1e-6) << approximation.name << ", " << name << ", draw " << seed << "\n"
                                     << check.report();
        worst = std::max(worst, check.worst);
      }
      RecordProperty(approximation.name + ", " + name, fmt::format("{:.1e}", worst));
    }
}

TEST(Likelihood, GradientIsThatOfTheValueWithItsJitter) {
  const Kernel kernel{{RbfTerm{1, 0.01}, WhiteTerm{0.3}}};
  for (const auto& approximation : approximations(blocks)) {
    const auto likelihood = approximation.make();
    if (!likelihood->has_inducing()) continue;
    LikelihoodCost cost(*likelihood, kernel, 8, 2, 4, 2);
    Eigen::VectorXd p = gaussian(cost.size(), 1, 5);
    p.tail(3) = log_parameters(kernel);
    p.segment(16, 8) = Eigen::MatrixXd::Ones(4, 2).reshaped();
    double value = 0, ahead = 0, behind = 0;
    Eigen::VectorXd gradient;
    ASSERT_TRUE(cost.evaluate(p, value, &gradient));
    EXPECT_GT(likelihood->jitter(), 0) << approximation.name;
    for (const Eigen::Index parameter : {p.size() - 3, p.size() - 2, p.size() - 1, Eigen::Index{0}, Eigen::Index{30}}) {
      Eigen::VectorXd step = Eigen::VectorXd::Unit(p.size(), parameter) * 1e-3;
      ASSERT_TRUE(cost.evaluate(p + step, ahead, nullptr) && cost.evaluate(p - step, behind, nullptr));
      EXPECT_NEAR(gradient[parameter], (ahead - behind) / 2e-3, 1e-4 * std::max(1.0, std::abs(gradient[parameter])))
          << approximation.name << ", " << cost.name(parameter);
    }
  }
}

TEST(Likelihood, WithAllPointsInducingIsTheFullProcess) {
  const auto x = apart(observation, 8, 1), y = gaussian(8, 4, 2), at = gaussian(6, 2, 3);
  FullLikelihood full;
  const double exact = full.evaluate(observation, x, x, y, nullptr);
  Predictive expected, predictive;
  expected.compute(full.posterior(observation, x, x, y), at);
  for (const auto& approximation : approximations(blocks)) {
    const auto likelihood = approximation.make();
    EXPECT_NEAR(likelihood->evaluate(observation, x, x, y, nullptr), exact, 1e-9) << approximation.name;
    predictive.compute(likelihood->posterior(observation, x, x, y), at);
    EXPECT_TRUE(predictive.mean().isApprox(expected.mean(), 1e-9)) << approximation.name;
    EXPECT_TRUE(predictive.variance().isApprox(expected.variance(), 1e-9)) << approximation.name;
  }
}

TEST(VariationalLikelihood, IsABoundOnTheFullDensity) {
  FullLikelihood full;
  VariationalLikelihood bound;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto x = gaussian(30, 2, seed), y = gaussian(30, 2, 100 + seed), u = apart(observation, 5, 200 + seed);
    EXPECT_LT(bound.evaluate(observation, x, u, y, nullptr), full.evaluate(observation, x, u, y, nullptr));
  }
}

TEST(PitcLikelihood, OfBlocksOfOneIsFitcAndOfOneBlockTheFullProcess) {
  const auto x = gaussian(12, 2, 1), y = gaussian(12, 3, 2), u = apart(observation, 4, 3);
  FitcLikelihood fitc;
  FullLikelihood full;
  PitcLikelihood ones(std::vector<Eigen::Index>(12, 1)), one({12});
  EXPECT_NEAR(ones.evaluate(observation, x, u, y, nullptr), fitc.evaluate(observation, x, u, y, nullptr), 1e-10);
  EXPECT_NEAR(one.evaluate(observation, x, u, y, nullptr), full.evaluate(observation, x, u, y, nullptr), 1e-10);
}

TEST(PitcLikelihood, TakesBlocksOfOneSequenceAndRefusesOthers) {
  EXPECT_EQ(blocks_within({7, 3, 1}, 3), (std::vector<Eigen::Index>{2, 2, 3, 3, 1}));
  EXPECT_EQ(blocks_within({7}, 100), (std::vector<Eigen::Index>{7}));
  const auto x = gaussian(12, 2, 1), y = gaussian(12, 3, 2), u = apart(observation, 4, 3);
  EXPECT_THROW(PitcLikelihood({5, 6}).evaluate(observation, x, u, y, nullptr), std::invalid_argument);
  EXPECT_THROW(PitcLikelihood({12, 0}).evaluate(observation, x, u, y, nullptr), std::invalid_argument);
}

TEST(Likelihood, RefusesSizesThatDoNotFit) {
  const auto x = gaussian(8, 2, 1), y = gaussian(8, 3, 2), u = apart(observation, 4, 3);
  const Kernel three{{ArdTerm{1, Eigen::Vector3d::Ones()}, WhiteTerm{0.1}}};
  for (const auto& approximation : approximations(blocks)) {
    const auto likelihood = approximation.make();
    EXPECT_THROW(likelihood->evaluate(observation, x, u, y.topRows(7), nullptr), std::invalid_argument);
    EXPECT_THROW(likelihood->evaluate(observation, x.topRows(0), u, y.topRows(0), nullptr), std::invalid_argument);
    EXPECT_THROW(likelihood->evaluate(observation, x, u, y.leftCols(0), nullptr), std::invalid_argument);
    EXPECT_THROW(likelihood->evaluate(observation, x.leftCols(0), u.leftCols(0), y, nullptr), std::invalid_argument);
    EXPECT_THROW(likelihood->evaluate(three, x, u, y, nullptr), std::invalid_argument);
    if (!likelihood->has_inducing()) continue;
    EXPECT_THROW(likelihood->evaluate(observation, x, u.topRows(0), y, nullptr), std::invalid_argument);
    EXPECT_THROW(likelihood->evaluate(observation, x, u.leftCols(1), y, nullptr), std::invalid_argument);
  }
}

/// Evaluates with gradient, expecting finite numbers or an error; returns the error's text or "".
std::string evaluate(GpLikelihood& likelihood, const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u,
                     const Eigen::MatrixXd& y) {
  GpGradient g;
  g.set_zero(x.rows(), u.rows(), x.cols(), parameter_count(kernel));
  try {
    EXPECT_TRUE(std::isfinite(likelihood.evaluate(kernel, x, u, y, &g)));
    EXPECT_TRUE(g.inputs.allFinite() && g.inducing.allFinite() && g.kernel.allFinite() && g.outputs.allFinite());
  } catch (const FactorisationError& e) {
    return e.what();
  }
  return "";
}

TEST(Likelihood, AnswersDegenerateDataOrSaysWhyNot) {
  const Eigen::MatrixXd x = gaussian(8, 2, 1), y = gaussian(8, 3, 2), u = apart(observation, 4, 3);
  const Eigen::MatrixXd same = x.row(0).replicate(8, 1), many = gaussian(20, 2, 4);
  for (const auto& approximation : approximations(blocks)) {
    const auto likelihood = approximation.make();
    const auto answers = [&](const Kernel& k, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                             const Eigen::MatrixXd& c) { return evaluate(*likelihood, k, a, b, c) == ""; };
    SCOPED_TRACE(approximation.name);
    EXPECT_TRUE(answers(observation, same, u, y));             // repeated inputs
    EXPECT_TRUE(answers(observation, x, same.topRows(4), y));  // repeated inducing points
    EXPECT_TRUE(answers(observation, x, many, y));             // fewer frames than inducing points
    EXPECT_TRUE(answers(observation, x, u, y * 0));            // outputs that do not vary
    EXPECT_TRUE(answers(observation, x * 1e-150, u * 1e-150, y));
    EXPECT_TRUE(answers(observation, x * 1e150, u * 1e150, y));
    EXPECT_TRUE(answers(observation, x, u, y * 1e-150));
    EXPECT_TRUE(answers(observation, x, u, y * 1e150));
    EXPECT_TRUE(answers({{RbfTerm{1e150, 1}, WhiteTerm{1e149}}}, x, u, y));
    EXPECT_TRUE(answers({{RbfTerm{1e-140, 1}, WhiteTerm{1e-141}}}, x, u, y * 1e-70));
    const std::string nan = evaluate(*likelihood, observation, x, u, y * std::nan(""));
    EXPECT_NE(nan.find("outputs are not"), std::string::npos) << nan;
    const std::string overflow = evaluate(*likelihood, observation, x, u, y * 1e160);
    EXPECT_NE(overflow.find("scale them"), std::string::npos) << overflow;
    EXPECT_NE(evaluate(*likelihood, observation, x * std::nan(""), u, y), "");
    if (!likelihood->has_inducing()) continue;
    EXPECT_NE(evaluate(*likelihood, observation, x, u * std::nan(""), y), "");
  }
}

TEST(Likelihood, OfOneFrameIsThatOfANormalVariable) {
  const Eigen::MatrixXd x = gaussian(1, 2, 1), y = gaussian(1, 3, 2);
  for (const auto& approximation : approximations({1})) {
    const auto likelihood = approximation.make();
    EXPECT_NEAR(likelihood->evaluate(observation, x, x, y, nullptr),
                testing::textbook_density(Eigen::MatrixXd::Constant(1, 1, 1.6), y), 1e-12)
        << approximation.name;
    EXPECT_EQ(evaluate(*likelihood, observation, x, gaussian(3, 2, 4), y), "") << approximation.name;
  }
}

TEST(Likelihood, NoiseOfNoughtIsRefusedWhereItIsNeeded) {
  const auto x = gaussian(8, 2, 1), y = gaussian(8, 3, 2);
  const Kernel silent{{RbfTerm{1, 1}}};
  for (const auto& approximation : approximations(blocks)) {
    if (approximation.name != "DTC" && approximation.name != "variational") continue;
    const auto likelihood = approximation.make();
    EXPECT_NE(evaluate(*likelihood, silent, x, apart(observation, 4, 3), y).find(more_noise), std::string::npos);
  }
}

TEST(Likelihood, BesideOthersGivesTheSameBits) {
  const Eigen::MatrixXd x = gaussian(250, 3, 1), y = gaussian(250, 5, 2), u = gaussian(30, 3, 3);
  const Kernel kernel{{RbfTerm{1.3, 0.7}, LinearTerm{0.4}, BiasTerm{0.2}, WhiteTerm{0.1}}};
  for (const auto& approximation : approximations({90, 60, 100})) {
    const auto once = [&] {
      const auto likelihood = approximation.make();
      LikelihoodCost cost(*likelihood, kernel, 250, 3, 30, 5);
      Eigen::VectorXd p(cost.size()), gradient;
      p << x.reshaped(), u.reshaped(), y.reshaped(), log_parameters(kernel);
      double value = 0;
      cost.evaluate(p, value, &gradient);
      gradient.conservativeResize(gradient.size() + 1);
      gradient[gradient.size() - 1] = value;
      return gradient;
    };
    const Eigen::VectorXd alone = once();
    std::vector<Eigen::VectorXd> beside(8);
    std::vector<std::thread> threads;
    for (auto& result : beside) threads.emplace_back([&] { result = once(); });
    for (auto& thread : threads) thread.join();
    for (const auto& result : beside) EXPECT_EQ(result, alone) << approximation.name;
  }
}

TEST(Predictive, IsTheClosedFormOfTheFullProcess) {
  const auto x = gaussian(9, 2, 1), y = gaussian(9, 3, 2), at = gaussian(4, 2, 3);
  FullLikelihood full;
  Predictive predictive;
  predictive.compute(full.posterior(observation, x, x, y), at);
  const Eigen::MatrixXd inverse = testing::textbook_inverse(testing::textbook_full(observation, x));
  const Eigen::MatrixXd k = testing::textbook_matrix(observation, at, x);
  EXPECT_TRUE(predictive.mean().isApprox(k * inverse * y, 1e-10));
  const Eigen::VectorXd variance =
      (testing::textbook_matrix(observation, at, at) - k * inverse * k.transpose()).diagonal().array() + 0.1;
  EXPECT_TRUE(predictive.variance().isApprox(variance, 1e-10));
}

TEST(Predictive, OfTheApproximationsIsTheConditionalOfTheirJointDensity) {
  const auto x = gaussian(8, 2, 1), y = gaussian(8, 3, 2), at = gaussian(3, 2, 3), u = apart(observation, 4, 5);
  Eigen::MatrixXd all(11, 2);
  all << x, at;
  const Eigen::MatrixXd q = testing::textbook_q(observation, all, u);
  const std::map<std::string, Eigen::MatrixXd> covariances{{"DTC", testing::textbook_dtc(observation, x, u)},
                                                           {"FITC", testing::textbook_fitc(observation, x, u)},
                                                           {"PITC", testing::textbook_pitc(observation, x, u, blocks)},
                                                           {"variational", testing::textbook_dtc(observation, x, u)}};
  for (const auto& approximation : approximations(blocks)) {
    if (approximation.name == "full") continue;
    const Eigen::MatrixXd inverse = testing::textbook_inverse(covariances.at(approximation.name)),
                          cross = q.bottomLeftCorner(3, 8);
    Predictive predictive;
    predictive.compute(approximation.make()->posterior(observation, x, u, y), at);
    EXPECT_TRUE(predictive.mean().isApprox(cross * inverse * y, 1e-9)) << approximation.name;
    const Eigen::VectorXd variance =
        testing::textbook_full(observation, at).diagonal() - (cross * inverse * cross.transpose()).diagonal();
    EXPECT_TRUE(predictive.variance().isApprox(variance, 1e-9)) << approximation.name;
  }
}

TEST(Predictive, OfAReductionIsThatOfItsRoot) {
  const auto x = gaussian(9, 2, 1), y = gaussian(9, 3, 2), at = gaussian(4, 2, 3);
  GaussianProcess gp = FullLikelihood().posterior(observation, x, x, y);
  Predictive root, reduction;
  root.compute(gp, at);
  gp.reduction = gp.root * gp.root.transpose();
  gp.root.resize(0, 0);
  reduction.compute(gp, at);
  EXPECT_TRUE(root.variance().isApprox(reduction.variance(), 1e-10));
}

TEST(Predictive, VarianceNeverFallsBelowTheNoise) {
  Eigen::MatrixXd x = gaussian(30, 2, 1) * 1e-3;
  x.bottomRows(15) = x.topRows(15);
  const Kernel kernel{{RbfTerm{100, 1e-3}, WhiteTerm{1e-6, 0}}};
  const auto y = gaussian(30, 2, 2);
  Predictive predictive;
  for (const auto& approximation : approximations({10, 20})) {
    predictive.compute(approximation.make()->posterior(kernel, x, x.topRows(10), y), x);
    EXPECT_TRUE((predictive.variance().array() >= 1e-6).all()) << approximation.name;
    EXPECT_TRUE(predictive.mean().allFinite()) << approximation.name;
  }
}

/// k(U, U) has a condition of 1e13, its inverse and a reduction entries of that size.
TEST(Predictive, KeepsItsDigitsWhereTheBasisIsNearlySingular) {
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const auto x = gaussian(50, 1, 1), u = Eigen::MatrixXd(Eigen::VectorXd::LinSpaced(14, -2, 2)), y = gaussian(50, 2, 3);
  const Kernel kernel{{RbfTerm{1, 2}, WhiteTerm{1e-3}}};
  const auto covariance = [](const Matrix& a, const Matrix& b) {
    return Matrix(Matrix::NullaryExpr(
        a.rows(), b.rows(), [&](auto i, auto j) { return std::exp(-(a(i, 0) - b(j, 0)) * (a(i, 0) - b(j, 0))); }));
  };
  const Matrix points = x.cast<long double>(), basis = u.cast<long double>();
  const Matrix kuu = covariance(basis, basis), kfu = covariance(points, basis), inverse = kuu.inverse();
  const Matrix lambda =
      (1.001L - (kfu * inverse).cwiseProduct(kfu).rowwise().sum().array()).inverse().matrix().asDiagonal();
  const Matrix reduction = inverse - Matrix(kuu + kfu.transpose() * lambda * kfu).inverse();
  const Eigen::VectorXd exact =
      (1.001L - (kfu * reduction).cwiseProduct(kfu).rowwise().sum().array()).matrix().cast<double>();
  FitcLikelihood fitc;
  Predictive predictive;
  predictive.compute(fitc.posterior(kernel, x, u, y), x);
  EXPECT_EQ(fitc.jitter(), 0);
  EXPECT_LT((predictive.variance() - exact).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace talkgraph
