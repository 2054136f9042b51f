#include "nodes/latent/sgpdm_objective.h"

#include <gtest/gtest.h>

#include <tuple>

#include "nodes/latent/latent_training.h"
#include "tests/nodes/latent/textbook.h"

namespace talkgraph {
namespace {

using testing::gaussian;

constexpr Eigen::Index frames = 7, latent = 2;
const std::vector<std::int64_t> lengths = {3, 1, 3}, steps = {2, 2};

enum class Kernels {
  rbf,        // RBF and bias
  ard,        // one width a dimension
  one_stream  // ARD and linear, of one stream
};

struct Combination {
  CovarianceApproximation approximation = CovarianceApproximation::full;
  BackConstraintKind back_constraint = BackConstraintKind::none;
  LatentDynamics dynamics = LatentDynamics::absolute;
  Kernels kernels = Kernels::rbf;
  bool learn_scale = true;
  bool first_is_noise = false;
};

/// The longest block of PITC.
constexpr Eigen::Index block = 2;

GpStream stream(const Combination& c, std::string name, Kernel kernel, const std::vector<std::int64_t>& sequences,
                double weight, std::uint64_t seed, Eigen::Index inputs = latent) {
  const bool sparse = c.approximation != CovarianceApproximation::full;
  return {std::move(name), std::move(kernel), sparse ? gaussian(3, inputs, seed) : Eigen::MatrixXd(0, inputs),
          make_likelihood(c.approximation, sequences, block), weight};
}

bool timed(const Combination& c) { return c.dynamics == LatentDynamics::time || c.dynamics == LatentDynamics::phase; }

SgpdmProblem problem(const Combination& c) {
  SgpdmProblem p;
  Kernel audio{{RbfTerm{1.2, 0.8}, BiasTerm{0.1}, WhiteTerm{0.2, 0.01}}};
  Kernel visual{{RbfTerm{0.9, 1.1}, BiasTerm{0.2}, WhiteTerm{0.1, 0.01}}};
  if (c.kernels != Kernels::rbf) {
    audio.terms[0] = ArdTerm{1.2, Eigen::Vector2d(0.6, 1.5)};
    visual.terms[0] = ArdTerm{0.9, Eigen::Vector2d(2, 0.4)};
  }
  if (c.kernels == Kernels::one_stream) audio.terms.push_back(LinearTerm{0.3});
  p.observations.push_back(
      {stream(c, "audio", audio, lengths, 1, 4), gaussian(frames, 3, 1), Eigen::RowVector3d(0.5, 1, 2), c.learn_scale});
  if (c.kernels != Kernels::one_stream)
    p.observations.push_back({stream(c, "visual", visual, lengths, 1.5, 5), gaussian(frames, 2, 2),
                              Eigen::RowVector2d(0.7, 3), c.learn_scale});
  p.latents = gaussian(frames, latent, 3);
  const Eigen::MatrixXd heard = p.observations[0].values;
  if (c.back_constraint == BackConstraintKind::mlp) p.back_constraint.emplace(perceptron(heard, p.latents, 3), heard);
  if (c.back_constraint == BackConstraintKind::kbr)
    p.back_constraint.emplace(kernel_regression(heard, p.latents, 0.7), heard);
  p.lengths = lengths;
  p.dynamics_weight = 2;
  if (!c.first_is_noise && !timed(c)) p.first_variance = 0.7;
  if (c.dynamics == LatentDynamics::difference) p.form = DynamicsForm::difference;
  if (c.dynamics == LatentDynamics::time) p.form = DynamicsForm::time;
  if (c.dynamics == LatentDynamics::phase) p.form = DynamicsForm::phase;
  if (timed(c))
    p.dynamics = stream(c, "dynamics", {{RbfTerm{1, 3}, LinearTerm{0.7}, WhiteTerm{0.1, 0.01}}}, lengths, 2, 6, 1);
  else if (c.dynamics != LatentDynamics::none)
    p.dynamics = stream(c, "dynamics", {{RbfTerm{0.3, 3}, LinearTerm{0.7}, WhiteTerm{0.1, 0.01}}}, steps, 2, 6);
  return p;
}

/// ln p(Y | X) of one process.
double textbook(const Combination& c, const GpStream& s, const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                const std::vector<std::int64_t>& sequences) {
  using namespace testing;
  switch (c.approximation) {
    case CovarianceApproximation::full:
      return textbook_density(textbook_full(s.kernel, x), y);
    case CovarianceApproximation::dtc:
      return textbook_density(textbook_dtc(s.kernel, x, s.inducing), y);
    case CovarianceApproximation::fitc:
      return textbook_density(textbook_fitc(s.kernel, x, s.inducing), y);
    case CovarianceApproximation::pitc:
      return textbook_density(textbook_pitc(s.kernel, x, s.inducing, blocks_within(sequences, block)), y);
    case CovarianceApproximation::variational:
      return textbook_bound(s.kernel, x, s.inducing, y);
  }
  return 0;
}

/// Eqn 4.69 as a textbook writes it, at the problem's own start.
double textbook(const Combination& c, const SgpdmProblem& p) {
  const Eigen::MatrixXd x = p.back_constraint ? latent_points(p.back_constraint->with(p.back_constraint->parameters()),
                                                              p.observations[0].values)
                                              : p.latents;
  double value = 0;
  for (const auto& o : p.observations) {
    const Eigen::MatrixXd scaled = o.values.array().rowwise() / o.scale.array();
    value += o.process.weight *
             (textbook(c, o.process, x, scaled, lengths) - static_cast<double>(frames) * o.scale.array().log().sum());
  }
  if (timed(c)) {
    Eigen::VectorXd times(frames);
    if (c.dynamics == LatentDynamics::time)
      times << 0, 1, 2, 0, 0, 1, 2;
    else
      times << 1.0 / 6, 0.5, 5.0 / 6, 0.5, 1.0 / 6, 0.5, 5.0 / 6;
    return value + p.dynamics->weight * textbook(c, *p.dynamics, times, x, lengths);
  }
  if (!p.first_variance && !p.dynamics) return value;
  const double first_variance = p.first_variance ? *p.first_variance : testing::textbook_white(p.dynamics->kernel);
  Eigen::MatrixXd in(4, latent), out(4, latent), first(3, latent);
  in << x.middleRows(0, 2), x.middleRows(4, 2);
  out << x.middleRows(1, 2), x.middleRows(5, 2);
  first << x.row(0), x.row(3), x.row(4);
  value += p.dynamics_weight * testing::textbook_density(first_variance * Eigen::MatrixXd::Identity(3, 3), first);
  if (!p.dynamics) return value;
  if (p.form == DynamicsForm::difference) out -= in;
  return value + p.dynamics->weight * textbook(c, *p.dynamics, in, out, steps);
}

class SgpdmObjectives : public ::testing::TestWithParam<
                            std::tuple<CovarianceApproximation, BackConstraintKind, LatentDynamics, Kernels>> {
 protected:
  Combination combination(bool learn_scale, bool first_is_noise) const {
    const auto& [approximation, back_constraint, dynamics, kernels] = GetParam();
    return {approximation, back_constraint, dynamics, kernels, learn_scale, first_is_noise};
  }
};

template <class E>
std::string name_of(E value) {
  for (const auto& entry : enum_names<E>.entries)
    if (entry.value == value) return std::string(entry.name);
  return "?";
}

std::string name_of_combination(const ::testing::TestParamInfo<SgpdmObjectives::ParamType>& info) {
  const auto& [approximation, back_constraint, dynamics, kernels] = info.param;
  const char* const of_kernels[] = {"rbf", "ard", "one_stream"};
  return name_of(approximation) + "_" + name_of(back_constraint) + "_" + name_of(dynamics) + "_" +
         of_kernels[static_cast<int>(kernels)];
}

INSTANTIATE_TEST_SUITE_P(
    Every, SgpdmObjectives,
    ::testing::Combine(::testing::Values(CovarianceApproximation::full, CovarianceApproximation::dtc,
                                         CovarianceApproximation::fitc, CovarianceApproximation::pitc,
                                         CovarianceApproximation::variational),
                       ::testing::Values(BackConstraintKind::none, BackConstraintKind::mlp, BackConstraintKind::kbr),
                       ::testing::Values(LatentDynamics::none, LatentDynamics::absolute, LatentDynamics::difference),
                       ::testing::Values(Kernels::rbf, Kernels::ard, Kernels::one_stream)),
    name_of_combination);

INSTANTIATE_TEST_SUITE_P(
    InTime, SgpdmObjectives,
    ::testing::Combine(::testing::Values(CovarianceApproximation::full, CovarianceApproximation::dtc,
                                         CovarianceApproximation::fitc, CovarianceApproximation::pitc,
                                         CovarianceApproximation::variational),
                       ::testing::Values(BackConstraintKind::none, BackConstraintKind::mlp),
                       ::testing::Values(LatentDynamics::time, LatentDynamics::phase), ::testing::Values(Kernels::rbf)),
    name_of_combination);

TEST_P(SgpdmObjectives, AreEquation469) {
  for (const bool learn_scale : {false, true})
    for (const bool first_is_noise : {false, true}) {
      const Combination c = combination(learn_scale, first_is_noise);
      const double expected = textbook(c, problem(c));
      SgpdmObjective objective(problem(c));
      EXPECT_NEAR(objective.value(objective.start(), nullptr), expected, 1e-9 * std::abs(expected));
    }
}

TEST_P(SgpdmObjectives, HaveGradientsThatAgreeWithDifferences) {
  double worst = 0;
  for (std::uint64_t draw = 0; draw < 100; ++draw) {
    SgpdmProblem drawn = problem(combination(draw % 2, draw % 4 < 2));
    drawn.prior_deviation = draw % 3 ? 0 : 1.5;
    SgpdmObjective objective(std::move(drawn));
    const Eigen::VectorXd at = objective.start() + 0.3 * gaussian(objective.size(), 1, draw);
    auto check = check_gradient(objective, at);
    // Inducing points that nearly coincide want smaller steps.
    if (check.worst >= 1e-6) check = check_gradient(objective, at, 5e-5);
    EXPECT_TRUE(check.evaluated && check.cost_consistent);
    EXPECT_LT(check.worst, 1e-6) << "draw " << draw << ": " << check.report();
    worst = std::max(worst, check.worst);
  }
  RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
}

TEST(SgpdmObjective, FixedParametersHaveNoDerivative) {
  SgpdmProblem p = problem({.approximation = CovarianceApproximation::fitc, .learn_scale = false});
  p.fixed = {"latents", "inducing", "audio.white", "dynamics.inverse_width"};
  SgpdmObjective objective(std::move(p));
  double cost = 0;
  Eigen::VectorXd g;
  ASSERT_TRUE(objective.evaluate(objective.start(), cost, &g));
  EXPECT_TRUE(g.head(14 + 3 * 6).isZero(0));
  EXPECT_EQ((g.tail(12).array() == 0).count(), 2);
  objective.hold_noise(true);
  ASSERT_TRUE(objective.evaluate(objective.start(), cost, &g));
  EXPECT_EQ((g.tail(12).array() == 0).count(), 4);
  objective.hold_noise(false);
  ASSERT_TRUE(objective.evaluate(objective.start(), cost, &g));
  EXPECT_EQ((g.tail(12).array() == 0).count(), 2);
  SgpdmProblem bad = problem({});
  bad.fixed = {"audio.linear"};
  EXPECT_THROW(SgpdmObjective{std::move(bad)}, std::invalid_argument);
}

TEST(SgpdmObjective, NamesItsParameters) {
  const SgpdmObjective objective(problem({.approximation = CovarianceApproximation::fitc}));
  EXPECT_EQ(objective.name(0), "latent point 0, dimension 0");
  EXPECT_EQ(objective.name(frames + 2), "latent point 2, dimension 1");
  EXPECT_EQ(objective.name(2 * frames + 6 + 4), "visual inducing point 1, dimension 1");
  EXPECT_EQ(objective.name(2 * frames + 18 + 3), "visual log scale 0");
  EXPECT_EQ(objective.name(objective.size() - 1), "log dynamics.white");
  EXPECT_EQ(SgpdmObjective(problem({.back_constraint = BackConstraintKind::mlp})).name(1),
            "parameter 1 of the back-constraint");
}

TEST(SgpdmObjective, DoesNotLearnTheScaleOfAConstantDimension) {
  SgpdmProblem p = problem({});
  p.observations[0].values.col(1).setZero();
  SgpdmObjective objective(std::move(p));
  double cost = 0;
  Eigen::VectorXd g;
  ASSERT_TRUE(objective.evaluate(objective.start(), cost, &g));
  const Eigen::VectorXd scales = g.segment(14, 5);
  EXPECT_EQ(scales[1], 0);
  EXPECT_TRUE((scales(Eigen::ArrayXi{{0, 2, 3, 4}}).array() != 0).all());
}

TEST(SgpdmObjective, GivesTheBackConstraintItWasTrainedTo) {
  SgpdmProblem p = problem({.back_constraint = BackConstraintKind::mlp});
  const Eigen::MatrixXd heard = p.observations[0].values;
  SgpdmObjective objective(std::move(p));
  const Eigen::VectorXd at = objective.start() + 0.1 * gaussian(objective.size(), 1, 1);
  EXPECT_TRUE(latent_points(*objective.back_constraint(at), heard).isApprox(objective.latents(at), 1e-13));
}

}  // namespace
}  // namespace talkgraph
