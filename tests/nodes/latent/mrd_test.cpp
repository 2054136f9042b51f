#include "nodes/latent/mrd.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "nodes/latent/latent_dynamics.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/sequence_objective.h"
#include "tests/nodes/latent/gaussian.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using ::testing::ElementsAre;
using testing::gaussian;
using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Outputs of a Gaussian process over x, with noise of a tenth of their deviation.
Eigen::MatrixXd drawn(const Eigen::MatrixXd& x, Eigen::Index outputs, std::uint64_t seed) {
  Eigen::MatrixXd k(x.rows(), x.rows());
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index j = 0; j < x.rows(); ++j) k(i, j) = std::exp(-0.15 * (x.row(i) - x.row(j)).squaredNorm());
  k.diagonal().array() += 1e-6;
  const Eigen::MatrixXd root = k.llt().matrixL();
  return root * gaussian(x.rows(), outputs, seed) + 0.1 * gaussian(x.rows(), outputs, seed + 1);
}

/// Latent dimension 0 is shared, 1 is of the audio only, 2 of the visual stream only.
StateData shared_and_private(Eigen::Index frames, std::uint64_t seed) {
  const Eigen::MatrixXd x = gaussian(frames, 3, seed);
  return {"k-ae", {drawn(x(Eigen::all, {0, 1}), 12, seed + 10)}, {drawn(x(Eigen::all, {0, 2}), 15, seed + 20)}};
}

/// The same frames in windows of 10.
StateData cut(const StateData& data) {
  StateData parts{data.label, {}, {}};
  for (Eigen::Index t = 0; t < data.audio[0].rows(); t += 10) {
    parts.audio.push_back(data.audio[0].middleRows(t, 10));
    parts.visual.push_back(data.visual[0].middleRows(t, 10));
  }
  return parts;
}

TrainMrd::Out trained(const TrainMrd& node, const StateData& data) {
  Context context;
  Random random(1);
  return node(data, context, random);
}

std::string failure(const StateData& data) {
  try {
    trained({}, data);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(TrainMrd, FindsSharedAndPrivateDimensions) {
  for (std::uint64_t seed = 100; seed < 103; ++seed) {
    TrainMrd node;
    node.iterations = 220;
    node.visual_only = VisualOnly::keep;
    const auto out = trained(node, shared_and_private(80, seed));
    EXPECT_EQ(out.dimensions.cells[0][0], 80);
    EXPECT_EQ(out.dimensions.cells[0][1], 1) << "shared, seed " << seed;
    EXPECT_EQ(out.dimensions.cells[0][2], 1) << "audio, seed " << seed;
    EXPECT_EQ(out.dimensions.cells[0][3], 1) << "visual, seed " << seed;
    EXPECT_EQ(out.model.latents.cols(), 3);
    EXPECT_THAT(out.relevance.rows, ElementsAre("1 (shared)", HasSubstr("2 ("), HasSubstr("3 (")));
  }
}

TEST(TrainMrd, FindsTheDimensionOfOneModel) {
  const Eigen::MatrixXd x = gaussian(120, 3, 5);
  const StateData data{"a", {drawn(x, 12, 6)}, {drawn(x, 12, 8)}};
  const auto out = trained({}, data);
  EXPECT_EQ(out.dimensions.cells[0][1], 3);
  EXPECT_EQ(out.dimensions.cells[0][2] + out.dimensions.cells[0][3], 0);
}

TEST(TrainMrd, FindsThemInPartsToo) {
  TrainMrd node;
  node.batch = 40;
  node.epochs = 600;
  const auto out = trained(node, cut(shared_and_private(120, 100)));
  EXPECT_EQ(out.dimensions.cells[0][1], 1);
  EXPECT_EQ(out.dimensions.cells[0][2], 1);
  EXPECT_EQ(out.dimensions.cells[0][3], 1);
}

TEST(TrainMrd, InPartsTracesTheBoundOfAllFramesAndSaysWhyItEnded) {
  const StateData data = cut(shared_and_private(120, 100));
  TrainMrd node;
  node.iterations = 320;
  const Sgpdm whole = trained(node, data).model;
  node.batch = 40;
  node.epochs = 5;
  const Sgpdm few = trained(node, data).model;
  EXPECT_EQ(few.trace.size(), 6u);
  EXPECT_EQ(few.trace[0], whole.trace[0]);
  EXPECT_EQ(few.ended, "epoch limit");
  EXPECT_EQ(few.iterations, 5);
  EXPECT_EQ(few.log_likelihood, *std::max_element(few.trace.begin(), few.trace.end()));
  EXPECT_LT(few.log_likelihood, whole.log_likelihood - 500);
  node.epochs = 3000;
  const Sgpdm many = trained(node, data).model;
  EXPECT_EQ(many.ended, "converged");
  EXPECT_LT(many.iterations, 3000);
  RecordProperty("behind", fmt::format("{:.1f}", whole.log_likelihood - many.log_likelihood));
  EXPECT_GT(many.log_likelihood, whole.log_likelihood - 120);
}

/// Mean squared error of the visual frames at their latent points where `at` holds, as a share of that of the mean.
double error_at(const Sgpdm& model, const Eigen::MatrixXd& truth, const Eigen::Array<bool, -1, -1>& at) {
  Predictive p;
  p.compute(model.visual, model.latents);
  const Eigen::ArrayXXd error = (unscaled(model.visual, p.mean()) - truth).array().square();
  const Eigen::ArrayXXd power = (truth.rowwise() - model.visual.mean).array().square();
  return at.select(error, 0.0).sum() / at.select(power, 0.0).sum();
}

TEST(TrainMrd, RecoversMissingValues) {
  const Eigen::MatrixXd x = gaussian(100, 2, 3);
  StateData data{"a", {drawn(x, 12, 4)}, {drawn(x, 10, 6)}};
  const Eigen::MatrixXd truth = data.visual[0];
  Random random(4);
  Eigen::Array<bool, -1, -1> missing = Eigen::Array<bool, -1, -1>::Constant(100, 10, false);
  for (auto& m : missing.reshaped()) m = random.uniform() < 0.1;
  missing.middleRows(20, 10).setConstant(true);
  data.visual[0] = missing.select(Eigen::MatrixXd::Constant(100, 10, nan), truth);
  data.audio[0](3, 4) = nan;
  const auto out = trained({}, data);
  EXPECT_LT(error_at(out.model, truth, missing), 0.15);
  EXPECT_LT(error_at(out.model, truth, !missing), 0.05);
  EXPECT_TRUE(out.model.audio_frames.allFinite());
}

TEST(TrainMrd, FillsLostFramesFromTheirNeighboursInTime) {
  Eigen::MatrixXd x(60, 2);
  for (Eigen::Index t = 0; t < 60; ++t)
    x.row(t) << std::sin(0.15 * static_cast<double>(t)), std::cos(0.1 * static_cast<double>(t));
  x *= 1.5;
  StateData data{"a", {drawn(x, 12, 4)}, {drawn(x, 10, 6)}};
  const Eigen::MatrixXd truth = data.visual[0];
  Eigen::Array<bool, -1, -1> missing = Eigen::Array<bool, -1, -1>::Constant(60, 10, false);
  missing.middleRows(30, 3).setConstant(true);
  data.audio[0].middleRows(30, 3).setConstant(nan);
  data.visual[0].middleRows(30, 3).setConstant(nan);
  TrainMrd node;
  node.time_width = 5;
  EXPECT_LT(error_at(trained(node, data).model, truth, missing), 0.3);
}

void expect_usable(const Sgpdm& model) {
  EXPECT_TRUE(model.latents.allFinite());
  EXPECT_GE(model.latents.cols(), 1);
  EXPECT_TRUE(std::isfinite(model.log_likelihood));
  Predictive p;
  for (const auto* gp : {&model.audio, &model.visual}) {
    p.compute(*gp, model.latents);
    EXPECT_TRUE(unscaled(*gp, p.mean()).allFinite());
    EXPECT_TRUE(p.variance().allFinite() && (p.variance().array() > 0).all());
  }
  if (model.dynamics) {
    p.compute(*model.dynamics, model.latents);
    EXPECT_TRUE(p.mean().allFinite());
  }
}

TEST(TrainMrd, AnswersDegenerateData) {
  for (const int batch : {0, 5}) {
    TrainMrd node;
    node.batch = batch;
    node.epochs = 20;
    node.iterations = 40;
    const auto windows = [](int count, Eigen::Index length) {
      StateData data{"a", {}, {}};
      for (int i = 0; i < count; ++i) {
        data.audio.push_back(gaussian(length, 4, 10 + static_cast<std::uint64_t>(i)));
        data.visual.push_back(gaussian(length, 3, 20 + static_cast<std::uint64_t>(i)));
      }
      return data;
    };
    const auto one = trained(node, windows(1, 1)).model;
    expect_usable(one);
    EXPECT_FALSE(one.dynamics);
    EXPECT_EQ(one.latents.cols(), 1);
    expect_usable(trained(node, windows(2, 1)).model);
    expect_usable(trained(node, windows(1, 3)).model);
    StateData constant = windows(3, 4);
    for (auto& y : constant.audio) y.setConstant(3);
    expect_usable(trained(node, constant).model);
    for (auto& z : constant.visual) z.setConstant(-2);
    const auto still = trained(node, constant).model;
    expect_usable(still);
    Predictive p;
    p.compute(still.visual, still.latents);
    EXPECT_TRUE(unscaled(still.visual, p.mean()).isApproxToConstant(-2, 1e-9));
    StateData twice = windows(2, 5);
    twice.audio[1] = twice.audio[0];
    twice.visual[1] = twice.visual[0];
    expect_usable(trained(node, twice).model);
    StateData scales = windows(4, 5);
    for (auto& y : scales.audio) y *= 1e8;
    for (auto& z : scales.visual) z *= 1e-8;
    scales.audio[0].col(1).setConstant(1);
    expect_usable(trained(node, scales).model);
    StateData gaps = windows(4, 5);
    gaps.visual[1].setConstant(nan);
    gaps.audio[2].row(1).setConstant(nan);
    gaps.visual[2].row(1).setConstant(nan);
    expect_usable(trained(node, gaps).model);
  }
}

TEST(TrainMrd, RefusesWhatItCannotTrainOn) {
  EXPECT_THAT(failure({"x", {}, {}}), HasSubstr("state \"x\": no training windows"));
  StateData data = shared_and_private(6, 1);
  data.visual[0].conservativeResize(5, Eigen::NoChange);
  EXPECT_THAT(failure(data), HasSubstr("window 0 is 6 × 12 of audio and 5 × 15 of visual"));
  data = shared_and_private(6, 1);
  data.audio[0](2, 3) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(failure(data), HasSubstr("audio stream has an infinite value in dimension 3"));
  data = shared_and_private(6, 1);
  data.visual[0].col(4).setConstant(nan);
  EXPECT_THAT(failure(data), HasSubstr("dimension 4 of the visual stream is missing in all 6 frames"));
  data.visual[0].setConstant(nan);
  EXPECT_THAT(failure(data), HasSubstr("is missing in all 6 frames"));
}

TEST(TrainMrd, RefusesAStartWhoseBoundOverflows) {
  TrainMrd node;
  node.noise = 1e-320;
  node.minimum_noise = 0;
  for (const int batch : {0, 20}) {
    node.batch = batch;
    EXPECT_THROW(trained(node, shared_and_private(30, 1)), std::runtime_error);
  }
}

TEST(TrainMrd, GivesTheSameBitsAgain) {
  StateData data = shared_and_private(60, 1);
  data.audio[0](3, 3) = nan;
  for (const int batch : {0, 20}) {
    TrainMrd node;
    node.batch = batch;
    node.iterations = 40;
    const auto a = trained(node, data).model, b = trained(node, data).model;
    EXPECT_EQ(a.latents, b.latents);
    EXPECT_EQ(a.visual.weights, b.visual.weights);
    EXPECT_EQ(a.log_likelihood, b.log_likelihood);
  }
}

TEST(TrainMrd, GoesOnWhereItWasStopped) {
  const StateData data = cut(shared_and_private(40, 1));
  const test::TemporaryFolder folder;
  for (const int batch : {0, 20})
    for (const auto optimiser : {OptimiserKind::scg, OptimiserKind::lbfgs}) {
      TrainMrd node;
      node.batch = batch;
      node.optimiser = optimiser;
      node.iterations = node.epochs = 30;
      node.hold_noise = 10;
      const Sgpdm whole = trained(node, data).model;
      node.checkpoint = folder.file("checkpoints");
      std::atomic<bool> cancel = false;
      Context context;
      context.cancel = &cancel;
      context.on_progress = [&](double share) { cancel = share > 0.49 && share < 0.51; };
      Random random(1);
      EXPECT_THROW(node(data, context, random), Cancelled);
      EXPECT_FALSE(std::filesystem::is_empty(node.checkpoint));
      int told = 0;
      Context on;
      on.on_progress = [&](double) { ++told; };
      Random again(1);
      const Sgpdm resumed = node(data, on, again).model;
      EXPECT_LT(told, batch ? 31 : 17);
      EXPECT_TRUE(std::filesystem::is_empty(node.checkpoint));
      if (optimiser == OptimiserKind::lbfgs && !batch) continue;  // begins with an empty memory
      EXPECT_EQ(resumed.latents, whole.latents);
      EXPECT_EQ(resumed.trace, whole.trace);
    }
}

TEST(TrainMrd, InPartsGoesOnFromAnyPartButNotWithAnotherSeed) {
  const StateData data = cut(shared_and_private(40, 1));
  const test::TemporaryFolder folder;
  TrainMrd node;
  node.batch = 10;
  node.epochs = 8;
  const auto with_seed = [&](std::uint64_t seed) {
    Context context;
    Random random(seed);
    return node(data, context, random).model;
  };
  const Sgpdm whole = with_seed(1), other = with_seed(2);
  EXPECT_NE(other.latents, whole.latents);
  node.checkpoint = folder.file("checkpoints");
  for (const double share : {0.2, 0.45, 0.6, 0.75}) {
    std::atomic<bool> cancel = false;
    Context context;
    context.cancel = &cancel;
    context.on_progress = [&](double done) { cancel = done > share; };
    Random random(1);
    EXPECT_THROW(node(data, context, random), Cancelled);
    EXPECT_FALSE(std::filesystem::is_empty(node.checkpoint)) << share;
    EXPECT_EQ(with_seed(2).latents, other.latents) << share;
    const Sgpdm resumed = with_seed(1);
    EXPECT_EQ(resumed.latents, whole.latents) << share;
    EXPECT_EQ(resumed.trace, whole.trace) << share;
  }
}

TEST(TrainMrd, KeepsToItsTimeLimit) {
  for (const int batch : {0, 20}) {
    TrainMrd node;
    node.batch = batch;
    node.iterations = node.epochs = 1000000;
    node.hold_noise = 100;
    node.time_limit = 0.2;
    const Sgpdm model = trained(node, cut(shared_and_private(60, 1))).model;
    EXPECT_EQ(model.ended, "time limit");
    EXPECT_GT(model.iterations, 0);
  }
}

TEST(TrainMrd, BothOptimisersRaiseTheBound) {
  const StateData data = shared_and_private(60, 1);
  TrainMrd node;
  node.iterations = 300;
  const Sgpdm scg = trained(node, data).model;
  node.optimiser = OptimiserKind::lbfgs;
  const Sgpdm lbfgs = trained(node, data).model;
  EXPECT_GT(scg.log_likelihood, scg.trace[0] + 500);
  EXPECT_NEAR(lbfgs.log_likelihood, scg.log_likelihood, 50);
}

TEST(TrainMrd, StopsWhenCancelled) {
  std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  Random random(1);
  TrainMrd node;
  EXPECT_THROW(node(shared_and_private(30, 1), context, random), Cancelled);
  node.batch = 10;
  EXPECT_THROW(node(shared_and_private(30, 1), context, random), Cancelled);
}

TEST(TrainMrd, ModelsServeSynthesis) {
  TrainMrd node;
  node.iterations = 50;
  const Sgpdm model = trained(node, shared_and_private(60, 2)).model;
  ASSERT_TRUE(model.dynamics);
  const Eigen::MatrixXd audio = model.audio_frames.topRows(5);
  SequenceObjective objective(model, audio, true);
  const auto check = check_gradient(objective, model.latents.topRows(5).reshaped());
  EXPECT_TRUE(check.evaluated && check.cost_consistent);
  EXPECT_LT(check.worst, 1e-6);
}

TEST(TrainMrd, AveragesOverWhatOnlyTheFaceShows) {
  const StateData data = shared_and_private(80, 3);
  TrainMrd node;
  node.visual_only = VisualOnly::keep;
  const auto whole = trained(node, data);
  node.visual_only = VisualOnly::average;
  const auto part = trained(node, data);
  ASSERT_GT(whole.dimensions.cells[0][3], 0);
  ASSERT_LT(part.model.latents.cols(), whole.model.latents.cols());
  EXPECT_EQ(part.relevance.cells, whole.relevance.cells);

  // Where the dimensions that are left stand in the whole model, in the same order.
  const Eigen::Index d = whole.model.latents.cols(), draws = 20000;
  Eigen::MatrixXd x = gaussian(draws, d, 9);
  for (Eigen::Index q = 0, at = 0; q < d; ++q)
    if (whole.relevance.cells[static_cast<std::size_t>(q)][0] >= node.relevant)
      x.col(q).setConstant(part.model.latents(7, at++));
  Predictive all, mean;
  all.compute(whole.model.visual, x);
  mean.compute(part.model.visual, part.model.latents.row(7));
  const Eigen::RowVectorXd expected = unscaled(whole.model.visual, all.mean()).colwise().mean();
  EXPECT_LT((unscaled(part.model.visual, mean.mean()) - expected).norm(), 0.02 * whole.model.visual.scale.norm());
  const Eigen::MatrixXd around = all.mean().rowwise() - all.mean().colwise().mean();
  const double variance = all.variance().mean() + around.squaredNorm() / static_cast<double>(around.size());
  EXPECT_NEAR(mean.variance()[0], variance, 0.05 * variance);
}

TEST(FitDynamics, LearnsADecay) {
  Eigen::MatrixXd x = gaussian(600, 1, 1);
  x(0, 0) = 0;
  for (Eigen::Index t = 1; t < 600; ++t) x(t, 0) = 0.8 * x(t - 1, 0) + 0.1 * x(t, 0);
  for (const int inducing : {20, 1000}) {
    const GaussianProcess h = fit_dynamics(x, {300, 300}, 1, inducing, 30);
    Predictive p;
    p.compute(h, Eigen::MatrixXd::Constant(1, 1, 0.2));
    EXPECT_NEAR(p.mean()(0), 0.16, 0.04);
    EXPECT_NEAR(std::sqrt(p.variance()[0]), 0.1, 0.02);
  }
}

TEST(FitDynamics, RefusesWhatOverflows) {
  Eigen::MatrixXd x = gaussian(8, 2, 1);
  for (Eigen::Index t = 1; t < 8; t += 2) x.row(t) *= 1e160;
  EXPECT_THROW(fit_dynamics(x, {2, 2, 2, 2}, 1, 10, 30), FactorisationError);
}

}  // namespace
}  // namespace talkgraph
