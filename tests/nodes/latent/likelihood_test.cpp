#include <gtest/gtest.h>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/objective.h"
#include "nodes/latent/predictive.h"
#include "tests/nodes/latent/textbook.h"

namespace talkgraph {
namespace {

using testing::gaussian;

const Kernel observation{{RbfTerm{1.3, 0.7}, BiasTerm{0.2}, WhiteTerm{0.1, 0.02}}};
const Kernel dynamics{{RbfTerm{0.4, 2}, LinearTerm{0.8}, WhiteTerm{0.05, 0.001}}};

TEST(FullLikelihood, IsTheTextbookDensity) {
  const auto x = gaussian(12, 2, 1), y = gaussian(12, 3, 2);
  FullLikelihood full;
  for (const Kernel& kernel : {observation, dynamics})
    EXPECT_NEAR(full.evaluate(kernel, x, Eigen::MatrixXd(0, 2), y, nullptr),
                testing::textbook_density(testing::textbook_full(kernel, x), y), 1e-9);
  EXPECT_EQ(full.jitter(), 0);
}

TEST(FitcLikelihood, IsTheTextbookDensity) {
  const auto x = gaussian(15, 2, 1), y = gaussian(15, 3, 2), u = gaussian(4, 2, 3);
  for (const double jitter : {0.0, 1e-6})
    for (const Kernel& kernel : {observation, dynamics}) {
      FitcLikelihood fitc(jitter);
      EXPECT_NEAR(fitc.evaluate(kernel, x, u, y, nullptr),
                  testing::textbook_density(testing::textbook_fitc(kernel, x, u, jitter), y), 1e-8);
    }
}

TEST(FitcLikelihood, WithAllPointsInducingIsTheFullProcess) {
  const auto x = gaussian(10, 3, 1), y = gaussian(10, 4, 2), at = gaussian(6, 3, 3);
  FullLikelihood full;
  FitcLikelihood fitc(0);
  EXPECT_NEAR(full.evaluate(observation, x, x, y, nullptr), fitc.evaluate(observation, x, x, y, nullptr), 1e-8);
  Predictive a, b;
  a.compute(full.posterior(observation, x, x, y), at);
  b.compute(fitc.posterior(observation, x, x, y), at);
  EXPECT_TRUE(a.mean().isApprox(b.mean(), 1e-8));
  EXPECT_TRUE(a.variance().isApprox(b.variance(), 1e-8));
}

/// A likelihood as a function of X, U, Y and the log parameters.
class LikelihoodCost : public Objective {
 public:
  LikelihoodCost(GpLikelihood& likelihood, Kernel kernel) : likelihood_(likelihood), kernel_(std::move(kernel)) {}
  Eigen::Index size() const override { return 24 + 8 + 36 + parameter_count(kernel_); }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    const Eigen::MatrixXd x = p.head(24).reshaped(12, 2), u = p.segment(24, 8).reshaped(4, 2),
                          y = p.segment(32, 36).reshaped(12, 3);
    set_log_parameters(kernel_, p.tail(parameter_count(kernel_)));
    GpGradient g;
    g.set_zero(12, 4, 2, parameter_count(kernel_));
    cost = likelihood_.evaluate(kernel_, x, u, y, gradient ? &g : nullptr);
    if (!gradient) return true;
    gradient->resize(size());
    *gradient << g.inputs.reshaped(), g.inducing.reshaped(), g.outputs.reshaped(), g.kernel;
    return true;
  }

 private:
  GpLikelihood& likelihood_;
  Kernel kernel_;
};

TEST(Likelihood, GradientsAgreeWithDifferences) {
  FullLikelihood full;
  FitcLikelihood fitc, exact_fitc(0);
  for (GpLikelihood* likelihood : std::initializer_list<GpLikelihood*>{&full, &fitc, &exact_fitc})
    for (const Kernel& kernel : {observation, dynamics})
      for (std::uint64_t seed = 0; seed < 5; ++seed) {
        LikelihoodCost cost(*likelihood, kernel);
        Eigen::VectorXd p = gaussian(cost.size(), 1, 20 + seed);
        p.tail(parameter_count(kernel)) = log_parameters(kernel) + 0.3 * p.tail(parameter_count(kernel));
        const auto check = check_gradient(cost, p);
        EXPECT_TRUE(check.evaluated && check.cost_consistent);
        EXPECT_LT(check.worst, 1e-6) << "parameter " << check.where;
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

TEST(Predictive, OfFitcIsTheConditionalOfItsJointDensity) {
  const auto x = gaussian(9, 2, 1), y = gaussian(9, 3, 2), at = gaussian(3, 2, 3), u = gaussian(4, 2, 5);
  Eigen::MatrixXd all(12, 2);
  all << x, at;
  const Eigen::MatrixXd joint = testing::textbook_fitc(observation, all, u, 1e-6);
  const Eigen::MatrixXd inverse = testing::textbook_inverse(joint.topLeftCorner(9, 9)),
                        cross = joint.bottomLeftCorner(3, 9);
  FitcLikelihood fitc;
  Predictive predictive;
  predictive.compute(fitc.posterior(observation, x, u, y), at);
  EXPECT_TRUE(predictive.mean().isApprox(cross * inverse * y, 1e-8));
  const Eigen::VectorXd variance =
      joint.bottomRightCorner(3, 3).diagonal() - (cross * inverse * cross.transpose()).diagonal();
  EXPECT_TRUE(predictive.variance().isApprox(variance, 1e-8));
}

TEST(Predictive, VarianceNeverFallsBelowTheNoise) {
  Eigen::MatrixXd x = gaussian(30, 2, 1) * 1e-3;
  x.bottomRows(15) = x.topRows(15);
  const Kernel kernel{{RbfTerm{100, 1e-3}, WhiteTerm{1e-6, 0}}};
  FullLikelihood full;
  FitcLikelihood fitc;
  Predictive predictive;
  const auto y = gaussian(30, 2, 2);
  for (const auto& gp : {full.posterior(kernel, x, x, y), fitc.posterior(kernel, x, x.topRows(10), y)}) {
    predictive.compute(gp, x);
    EXPECT_TRUE((predictive.variance().array() >= 1e-6).all());
    EXPECT_TRUE(predictive.mean().allFinite());
  }
}

}  // namespace
}  // namespace talkgraph
