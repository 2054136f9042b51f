#include "nodes/latent/sgpdm.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "nodes/latent/predictive.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sgpdm_objective.h"
#include "tests/nodes/latent/textbook.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::gaussian;

/// Smooth 2-D paths seen through fixed nonlinear maps with noise.
StateData wavy(int windows, int length, std::uint64_t seed = 1) {
  const auto to_audio = gaussian(4, 8, 101), to_visual = gaussian(4, 6, 102);
  Random random(seed);
  StateData data{"k-ae-t", {}, {}};
  for (int w = 0; w < windows; ++w) {
    Eigen::MatrixXd basis(length, 4);
    const double phase = 0.5 * random.normal(), speed = 0.4 + 0.05 * random.normal();
    for (int t = 0; t < length; ++t) {
      const double a = phase + speed * t;
      basis.row(t) << std::cos(a), std::sin(a), std::cos(2 * a), std::sin(2 * a);
    }
    data.audio.push_back(basis * to_audio + 0.05 * gaussian(length, 8, seed * 1000 + static_cast<std::uint64_t>(w)));
    data.visual.push_back(basis * to_visual + 0.05 * gaussian(length, 6, seed * 2000 + static_cast<std::uint64_t>(w)));
  }
  return data;
}

SgpdmProblem small_problem(bool sparse, bool with_dynamics) {
  SgpdmProblem p;
  p.audio = gaussian(10, 4, 1);
  p.visual = gaussian(10, 3, 2);
  p.latents = gaussian(10, 2, 3);
  p.lengths = {4, 1, 5};
  p.dynamics_weight = 2;
  p.first_variance = 0.7;
  p.log_scale = 1.5;
  const auto likelihood = [&]() -> std::unique_ptr<GpLikelihood> {
    if (sparse) return std::make_unique<FitcLikelihood>();
    return std::make_unique<FullLikelihood>();
  };
  const Eigen::MatrixXd none(0, 2);
  p.f = {"audio",
         {{RbfTerm{1.2, 0.8}, BiasTerm{0.1}, WhiteTerm{0.2, 0.01}}},
         sparse ? gaussian(4, 2, 4) : none,
         likelihood(),
         1};
  p.g = {"visual",
         {{RbfTerm{0.9, 1.1}, BiasTerm{0.2}, WhiteTerm{0.1, 0.01}}},
         sparse ? gaussian(3, 2, 5) : none,
         likelihood(),
         4.0 / 3};
  if (with_dynamics)
    p.h = GpStream{"dynamics",
                   {{RbfTerm{0.3, 3}, LinearTerm{0.7}, WhiteTerm{0.1, 0.01}}},
                   sparse ? gaussian(3, 2, 6) : none,
                   likelihood(),
                   2};
  return p;
}

TEST(SgpdmObjective, IsEquation469) {
  const SgpdmProblem p = small_problem(false, true);
  Eigen::MatrixXd in(7, 2), out(7, 2), first(3, 2);
  in << p.latents.middleRows(0, 3), p.latents.middleRows(5, 4);
  out << p.latents.middleRows(1, 3), p.latents.middleRows(6, 4);
  first << p.latents.row(0), p.latents.row(4), p.latents.row(5);
  const double expected = testing::textbook_density(testing::textbook_full(p.f.kernel, p.latents), p.audio) +
                          4.0 / 3 * testing::textbook_density(testing::textbook_full(p.g.kernel, p.latents), p.visual) +
                          2 * (testing::textbook_density(testing::textbook_full(p.h->kernel, in), out) +
                               testing::textbook_density(0.7 * Eigen::MatrixXd::Identity(3, 3), first)) -
                          1.5;
  SgpdmObjective objective(small_problem(false, true));
  EXPECT_NEAR(objective.log_likelihood(objective.start(), nullptr), expected, 1e-9);
}

TEST(SgpdmObjective, GradientsAgreeWithDifferencesForEveryCombination) {
  for (const bool sparse : {false, true})
    for (const bool with_dynamics : {false, true})
      for (const double prior : {0.0, 1.5}) {
        SgpdmProblem problem = small_problem(sparse, with_dynamics);
        problem.prior_deviation = prior;
        SgpdmObjective objective(std::move(problem));
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
          const auto check = check_gradient(objective, objective.start() + 0.3 * gaussian(objective.size(), 1, seed));
          EXPECT_TRUE(check.evaluated && check.cost_consistent);
          EXPECT_LT(check.worst, 1e-6) << "sparse " << sparse << " dynamics " << with_dynamics << " at " << check.where;
        }
      }
}

TEST(SgpdmObjective, FixedParametersHaveNoDerivative) {
  SgpdmProblem problem = small_problem(true, true);
  problem.fixed = {"latents", "inducing", "audio.white", "dynamics.inverse_width"};
  SgpdmObjective objective(std::move(problem));
  double cost = 0;
  Eigen::VectorXd g;
  ASSERT_TRUE(objective.evaluate(objective.start(), cost, &g));
  EXPECT_TRUE(g.head(20 + 8 + 6 + 6).isZero(0));
  EXPECT_EQ((g.tail(12).array() == 0).count(), 2);
  SgpdmProblem bad = small_problem(true, false);
  bad.fixed = {"audio.linear"};
  EXPECT_THROW(SgpdmObjective{std::move(bad)}, std::invalid_argument);
}

TEST(TrainSgpdm, FitsItsTrainingDataAndRaisesTheLikelihood) {
  const auto data = wavy(12, 5);
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.iterations = 0;
  const Sgpdm before = train(data, context);
  train.iterations = 60;
  const Sgpdm after = train(data, context);
  EXPECT_GT(after.log_likelihood, before.log_likelihood + 50);
  EXPECT_EQ(after.latents.rows(), 60);
  EXPECT_EQ(after.lengths, std::vector<std::int64_t>(12, 5));
  ASSERT_TRUE(after.dynamics);
  Predictive visual;
  visual.compute(after.visual, after.latents);
  const Eigen::MatrixXd fitted = unscaled(after.visual, visual.mean());
  double error = 0, power = 0;
  for (int w = 0; w < 12; ++w) {
    error += (fitted.middleRows(5 * w, 5) - data.visual[static_cast<std::size_t>(w)]).squaredNorm();
    power += (data.visual[static_cast<std::size_t>(w)].rowwise() - after.visual.mean).squaredNorm();
  }
  EXPECT_LT(error / power, 0.05);
}

TEST(TrainSgpdm, GivesTheSameBitsAgain) {
  const auto data = wavy(8, 4);
  Context context;
  TrainSgpdm train;
  train.iterations = 20;
  train.inducing = 10;
  const Sgpdm a = train(data, context), b = train(data, context);
  EXPECT_EQ(a.latents, b.latents);
  EXPECT_EQ(a.visual.weights, b.visual.weights);
  EXPECT_EQ(a.audio.basis.rows(), 10);
}

TEST(TrainSgpdm, ScalingChoicesKeepTheOutputsUnits) {
  auto data = wavy(10, 4);
  for (auto& z : data.visual) {
    z.col(0) *= 100;
    z.array() += 50;
  }
  Context context;
  for (const auto scaling : {OutputScaling::per_dimension, OutputScaling::common}) {
    TrainSgpdm train;
    train.visual_scaling = scaling;
    const Sgpdm model = train(data, context);
    Predictive visual;
    visual.compute(model.visual, model.latents);
    const Eigen::MatrixXd fitted = unscaled(model.visual, visual.mean());
    const double spread = (data.visual[0].col(0).array() - model.visual.mean[0]).matrix().norm();
    EXPECT_LT((fitted.col(0).head(4) - data.visual[0].col(0)).norm(), 0.3 * spread);
  }
}

void expect_usable(const Sgpdm& model) {
  EXPECT_TRUE(model.latents.allFinite());
  EXPECT_TRUE(std::isfinite(model.log_likelihood));
  Predictive p;
  for (const auto* gp : {&model.audio, &model.visual}) {
    p.compute(*gp, model.latents);
    EXPECT_TRUE(unscaled(*gp, p.mean()).allFinite());
    EXPECT_TRUE(p.variance().allFinite() && (p.variance().array() > 0).all());
  }
}

TEST(TrainSgpdm, AnswersDegenerateData) {
  Context context;
  const TrainSgpdm train;
  const Sgpdm one = train(wavy(1, 1), context);
  expect_usable(one);
  EXPECT_FALSE(one.dynamics);
  EXPECT_EQ(one.latents.cols(), 1);
  expect_usable(train(wavy(1, 3), context));
  expect_usable(train(wavy(3, 1), context));
  StateData constant = wavy(3, 2), twice = wavy(2, 3);
  for (auto& y : constant.audio) y.setConstant(3);
  for (auto& z : constant.visual) z.setConstant(-2);
  const Sgpdm still = train(constant, context);
  expect_usable(still);
  Predictive p;
  p.compute(still.visual, still.latents);
  EXPECT_TRUE(unscaled(still.visual, p.mean()).isApproxToConstant(-2, 1e-9));
  twice.audio[1] = twice.audio[0];
  twice.visual[1] = twice.visual[0];
  expect_usable(train(twice, context));
  StateData scales = wavy(10, 3);
  for (auto& y : scales.audio) y *= 1e8;
  for (auto& z : scales.visual) z *= 1e-8;
  expect_usable(train(scales, context));
  StateData column = wavy(10, 3);
  for (auto& y : column.audio) y.col(0).setConstant(1);
  expect_usable(train(column, context));
}

TEST(TrainSgpdm, RefusesWhatItCannotTrainOn) {
  Context context;
  const TrainSgpdm train;
  EXPECT_THROW(train(StateData{"x", {}, {}}, context), std::runtime_error);
  StateData data = wavy(2, 3);
  data.visual[1].conservativeResize(2, Eigen::NoChange);
  EXPECT_THROW(train(data, context), std::runtime_error);
  data = wavy(2, 3);
  data.audio[1](0, 0) = NAN;
  try {
    train(data, context);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("state \"k-ae-t\": window 1"), std::string::npos) << e.what();
  }
}

TEST(TrainSgpdm, StopsWhenCancelled) {
  std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  EXPECT_THROW(TrainSgpdm{}(wavy(5, 4), context), Cancelled);
}

TEST(Sgpdm, IsTheSameAfterSavingAndLoading) {
  Context context;
  TrainSgpdm train;
  train.iterations = 5;
  Sgpdm model = train(wavy(5, 4), context), loaded;
  const test::TemporaryFolder folder;
  const auto path = folder.file("sgpdm.h5");
  write_hdf5(path, [&](Archive& ar) { fields(ar, model); });
  fields(*hdf5_reader(path), loaded);
  const auto hash = [](Sgpdm& m) { return content_key([&](Archive& ar) { fields(ar, m); }); };
  EXPECT_EQ(hash(model), hash(loaded));
  EXPECT_EQ(loaded.visual.kernel.terms.size(), 3u);
}

TEST(SequenceObjective, GradientsAgreeWithDifferences) {
  Context context;
  const auto data = wavy(8, 5);
  for (const int inducing : {7, 100}) {
    TrainSgpdm train;
    train.latent_dimension = 3;
    train.iterations = 10;
    train.inducing = inducing;
    train.dynamics_inverse_width = 2;
    const Sgpdm model = train(data, context);
    const Eigen::MatrixXd audio = model.audio_frames.topRows(5) + 0.1 * gaussian(5, 8, 9);
    for (const bool with_dynamics : {false, true})
      for (const double follow : {0.0, 0.7}) {
        SequenceObjective objective(model, audio, with_dynamics);
        objective.follow(gaussian(1, 6, 4), follow);
        const Eigen::VectorXd start = model.latents.topRows(5).reshaped();
        const auto check = check_gradient(objective, start + 0.1 * gaussian(15, 1, 8));
        EXPECT_TRUE(check.evaluated && check.cost_consistent);
        EXPECT_LT(check.worst, 1e-6);
      }
  }
}

}  // namespace
}  // namespace talkgraph
