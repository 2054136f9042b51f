#include "nodes/latent/sgpdm.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cstdio>
#include <filesystem>
#include <map>

#include "nodes/latent/back_constraint.h"
#include "nodes/latent/clock.h"
#include "nodes/latent/compact.h"
#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/sequence_objective.h"
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

/// Share of the visual frames' power that the model leaves unexplained.
double unexplained(const Sgpdm& model, const StateData& data) {
  Predictive visual;
  visual.compute(model.visual, model.latents);
  const Eigen::MatrixXd fitted = unscaled(model.visual, visual.mean());
  double error = 0, power = 0;
  Eigen::Index row = 0;
  for (const auto& z : data.visual) {
    error += (fitted.middleRows(row, z.rows()) - z).squaredNorm();
    power += (z.rowwise() - model.visual.mean).squaredNorm();
    row += z.rows();
  }
  return error / power;
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
  EXPECT_LT(unexplained(after, data), 0.05);
}

TEST(TrainSgpdm, FitsWithEverySetting) {
  const auto data = wavy(12, 5);
  Context context;
  TrainSgpdm plain;
  plain.latent_dimension = 2;
  plain.iterations = 60;
  std::map<std::string, TrainSgpdm> settings;
  const auto add = [&](const std::string& name) -> TrainSgpdm& { return settings[name] = plain; };
  add("difference").dynamics = LatentDynamics::difference;
  add("time").dynamics = LatentDynamics::time;
  add("phase").dynamics = LatentDynamics::phase;
  add("no dynamics").dynamics = LatentDynamics::none;
  add("mlp").back_constraint = BackConstraintKind::mlp;
  add("kbr").back_constraint = BackConstraintKind::kbr;
  add("learnt scale").learn_scale = true;
  add("noise first").first_point = FirstPoint::noise;
  add("ard").kernel = ObservationKernel::ard;
  add("lbfgs").optimiser = OptimiserKind::lbfgs;
  add("held").hold_noise = 30;
  add("ppca").initial = LatentStart::ppca;
  add("cca").initial = LatentStart::cca;
  for (const auto& [name, train] : settings) {
    const Sgpdm model = train(data, context);
    EXPECT_LT(unexplained(model, data), 0.12) << name;
    EXPECT_TRUE(std::is_sorted(model.trace.begin(), model.trace.end())) << name;
    EXPECT_EQ(model.trace.back(), model.log_likelihood) << name;
    EXPECT_TRUE(model.ended == "converged" || model.ended == "iteration limit") << name << ": " << model.ended;
    EXPECT_EQ(model.dynamics.has_value(), name != "no dynamics");
    ASSERT_EQ(model.back_constraint.has_value(), name == "mlp" || name == "kbr");
    if (model.back_constraint) {
      EXPECT_TRUE(latent_points(*model.back_constraint, model.audio_frames).isApprox(model.latents, 1e-9));
    }
  }
}

/// Windows of the SGPDM's own density: points of a process from each to the next, and two streams of them.
struct Drawn {
  StateData data;
  Eigen::MatrixXd latents;
};
Drawn drawn_from(const Kernel& dynamics, const Kernel& audio, const Kernel& visual, int windows, Eigen::Index length) {
  constexpr Eigen::Index dimension = 2;
  Random random(1);
  Eigen::MatrixXd x(windows * length, dimension), from(0, dimension), to(0, dimension);
  for (Eigen::Index t = 0; t < x.rows(); ++t) {
    if (t % length == 0) {
      x.row(t) << random.normal(), random.normal();
      continue;
    }
    const Eigen::MatrixXd here = x.row(t - 1), k = testing::textbook_matrix(dynamics, here, from);
    const Eigen::MatrixXd weights = testing::textbook_full(dynamics, from).llt().solve(k.transpose());
    const double variance = testing::textbook_full(dynamics, here)(0) - (k * weights)(0);
    for (Eigen::Index c = 0; c < dimension; ++c)
      x(t, c) = (weights.transpose() * to.col(c))(0) + std::sqrt(variance) * random.normal();
    from.conservativeResize(from.rows() + 1, Eigen::NoChange);
    to.conservativeResize(from.rows(), Eigen::NoChange);
    from.bottomRows(1) = here;
    to.bottomRows(1) = x.row(t);
  }
  Drawn drawn{{"k-ae-t", {}, {}}, x};
  const auto observed = [&](const Kernel& kernel, Eigen::Index outputs, std::uint64_t seed) {
    const Eigen::MatrixXd root = testing::textbook_full(kernel, x).llt().matrixL();
    const Eigen::MatrixXd frames = root * gaussian(x.rows(), outputs, seed);
    std::vector<Eigen::MatrixXd> cut;
    for (int w = 0; w < windows; ++w) cut.push_back(frames.middleRows(w * length, length));
    return cut;
  };
  drawn.data.audio = observed(audio, 12, 1);
  drawn.data.visual = observed(visual, 10, 2);
  return drawn;
}

TEST(TrainSgpdm, RecoversTheModelThatTheDataWereDrawnFrom) {
  const Kernel dynamics{{RbfTerm{0.1, 1}, LinearTerm{1}, WhiteTerm{0.05}}};
  const Kernel audio{{RbfTerm{1, 0.1}, BiasTerm{0.1}, WhiteTerm{0.02}}};
  const Kernel visual{{RbfTerm{1, 0.2}, BiasTerm{0.1}, WhiteTerm{0.1}}};
  const Drawn drawn = drawn_from(dynamics, audio, visual, 10, 16);
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.approximation = CovarianceApproximation::full;
  train.audio_scaling = train.visual_scaling = OutputScaling::none;
  train.dynamics_bias = train.likelihood_bias = false;
  train.prior_deviation = 0;
  train.noise = 0.05;
  train.first_variance = 1;
  train.iterations = 300;
  // Where points are not integrated out, their density has no bound as they and the noise of their dynamics shrink.
  train.fixed = {"dynamics.rbf_variance", "dynamics.inverse_width", "dynamics.linear", "dynamics.white"};
  const Sgpdm model = train(drawn.data, context);

  Eigen::MatrixXd points(model.latents.rows(), 3);  // the space is known up to an affine map
  points << model.latents, Eigen::VectorXd::Ones(model.latents.rows());
  const Eigen::MatrixXd found = points * points.colPivHouseholderQr().solve(drawn.latents);
  EXPECT_LT((found - drawn.latents).squaredNorm(),
            0.02 * (drawn.latents.rowwise() - drawn.latents.colwise().mean()).squaredNorm());
  EXPECT_NEAR(testing::textbook_white(model.audio.kernel), 0.02, 0.2 * 0.02);
  EXPECT_NEAR(testing::textbook_white(model.visual.kernel), 0.1, 0.2 * 0.1);
  const auto inverse_width = [](const GaussianProcess& process) {
    return std::get<RbfTerm>(process.kernel.terms[0]).inverse_width;
  };
  EXPECT_NEAR(inverse_width(model.visual) / inverse_width(model.audio), 0.2 / 0.1, 0.2);
}

TEST(TrainSgpdm, LearntScalesKeepTheBackConstraintTrue) {
  const auto data = wavy(8, 4);
  Context context;
  for (const auto kind : {BackConstraintKind::mlp, BackConstraintKind::kbr}) {
    TrainSgpdm train;
    train.back_constraint = kind;
    train.learn_scale = true;
    train.prior_deviation = 0;
    const Sgpdm model = train(data, context);
    EXPECT_TRUE(latent_points(*model.back_constraint, model.audio_frames).isApprox(model.latents, 1e-9));
    EXPECT_TRUE(unscaled(model.audio, model.audio_frames).topRows(4).isApprox(data.audio[0], 1e-12));
  }
}

TEST(TrainSgpdm, HoldsTheNoiseForTheFirstIterations) {
  Context context;
  TrainSgpdm train;
  train.iterations = train.hold_noise = 10;
  EXPECT_NEAR(white_variance(train(wavy(6, 4), context).visual.kernel), 0.5, 1e-6);
  train.iterations = 15;
  EXPECT_GT(std::abs(white_variance(train(wavy(6, 4), context).visual.kernel) - 0.5), 1e-3);
}

TEST(TrainSgpdm, KeepsToItsTimeLimit) {
  Context context;
  TrainSgpdm train;
  train.iterations = 1000000;
  train.time_limit = 0.05;
  for (const int hold : {0, 1000000}) {
    train.hold_noise = hold;
    const Sgpdm model = train(wavy(20, 5), context);
    EXPECT_GT(model.iterations, 0);
    EXPECT_LT(model.iterations, 100000);
  }
}

TEST(TrainSgpdm, FirstPointsMayTakeTheNoiseOfTheDynamics) {
  Context context;
  TrainSgpdm train;
  train.first_point = FirstPoint::noise;
  const Sgpdm model = train(wavy(6, 4), context);
  EXPECT_DOUBLE_EQ(model.first_variance, white_variance(model.dynamics->kernel));
  EXPECT_EQ(train(wavy(6, 1), context).first_variance, 0.1);
}

/// ln p(Y | X) of a stream at the model's latent points.
double density(const GaussianProcess& gp, const Sgpdm& model, const std::vector<Eigen::MatrixXd>& windows) {
  Eigen::MatrixXd frames(model.latents.rows(), windows[0].cols());
  for (Eigen::Index row = 0; const auto& w : windows) {
    frames.middleRows(row, w.rows()) = w;
    row += w.rows();
  }
  return testing::textbook_density(testing::textbook_full(gp.kernel, model.latents), scaled(gp, frames)) -
         static_cast<double>(frames.rows()) * gp.scale.array().log().sum();
}

TEST(TrainSgpdm, WithoutDynamicsIsTheDensityOfTheFrames) {
  Context context;
  const StateData data = wavy(6, 4);
  TrainSgpdm train;
  train.dynamics = LatentDynamics::none;
  train.likelihood_bias = false;
  train.prior_deviation = 0;
  const Sgpdm plain = train(data, context);
  const double expected = density(plain.audio, plain, data.audio) + density(plain.visual, plain, data.visual);
  EXPECT_NEAR(plain.log_likelihood, expected, 1e-5 * std::abs(expected));
  train.dynamics_bias = false;
  train.latent_prior = true;
  const Sgpdm drawn = train(data, context);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(24, 24);
  EXPECT_NEAR(drawn.log_likelihood,
              density(drawn.audio, drawn, data.audio) + density(drawn.visual, drawn, data.visual) +
                  testing::textbook_density(identity, drawn.latents),
              1e-5 * std::abs(expected));
}

TEST(TrainSgpdm, GoesOnWhereItWasStopped) {
  const auto data = wavy(8, 4);
  const test::TemporaryFolder folder;
  for (const int hold : {0, 8, 25}) {
    TrainSgpdm train;
    train.iterations = 20;
    train.hold_noise = hold;
    Context context;
    const Sgpdm whole = train(data, context);
    train.checkpoint = folder.file("checkpoints");
    std::atomic<bool> cancel = false;
    Context stopped;
    stopped.cancel = &cancel;
    stopped.on_progress = [&](double share) { cancel = share >= 0.5; };
    EXPECT_THROW(train(data, stopped), Cancelled);
    EXPECT_FALSE(std::filesystem::is_empty(train.checkpoint));
    int told = 0;
    context.on_progress = [&](double) { ++told; };
    const Sgpdm resumed = train(data, context);
    EXPECT_EQ(resumed.latents, whole.latents);
    EXPECT_EQ(resumed.trace, whole.trace);
    EXPECT_LT(told, 12);
    EXPECT_TRUE(std::filesystem::is_empty(train.checkpoint));
    context.on_progress = nullptr;
  }
}

TEST(TrainSgpdm, GoesOnOnlyFromACheckpointOfTheSameTraining) {
  const auto data = wavy(8, 4);
  const test::TemporaryFolder folder;
  TrainSgpdm few, many;
  few.iterations = 5;
  many.iterations = 40;
  Context context;
  const Sgpdm expected = few(data, context);
  few.checkpoint = many.checkpoint = folder.file("checkpoints");
  std::atomic<bool> cancel = false;
  Context stopped;
  stopped.cancel = &cancel;
  stopped.on_progress = [&](double share) { cancel = share >= 0.5; };
  EXPECT_THROW(many(data, stopped), Cancelled);
  const Sgpdm model = few(data, context);
  EXPECT_EQ(model.iterations, 5);
  EXPECT_EQ(model.latents, expected.latents);
  EXPECT_FALSE(std::filesystem::is_empty(many.checkpoint)) << "the longer training's checkpoint is gone";
}

TEST(TrainSgpdm, BeginsAnewWhereACheckpointIsDamaged) {
  const auto data = wavy(6, 4);
  const test::TemporaryFolder folder;
  Context context;
  std::string warning;
  context.on_warning = [&](std::string_view text) { warning = text; };
  TrainSgpdm train;
  const Sgpdm whole = train(data, context);
  train.checkpoint = folder.file("checkpoints");
  for (const std::uintmax_t size : {0, 100, 3000}) {
    std::atomic<bool> cancel = false;
    Context stopped;
    stopped.cancel = &cancel;
    stopped.on_progress = [&](double share) { cancel = share >= 0.5; };
    EXPECT_THROW(train(data, stopped), Cancelled);
    const auto file = std::filesystem::directory_iterator(train.checkpoint)->path();
    ASSERT_GT(std::filesystem::file_size(file), size);
    std::filesystem::resize_file(file, size);
    EXPECT_EQ(train(data, context).trace, whole.trace);
    EXPECT_NE(warning.find("state \"k-ae-t\": the checkpoint cannot be read (" + train.checkpoint), std::string::npos)
        << warning;
    EXPECT_TRUE(std::filesystem::is_empty(train.checkpoint));
  }
}

TEST(TrainSgpdm, EndsAtOnceWhereItWasStoppedConverged) {
  const auto data = wavy(6, 4);
  const test::TemporaryFolder folder;
  Context context;
  TrainSgpdm train;
  train.iterations = 5000;
  const Sgpdm whole = train(data, context);
  ASSERT_EQ(whole.ended, "converged");
  train.checkpoint = folder.file("checkpoints");
  std::atomic<bool> cancel = false;
  Context stopped;
  stopped.cancel = &cancel;
  std::int64_t told = 0;
  stopped.on_progress = [&](double) { cancel = ++told == whole.iterations - 1; };
  EXPECT_THROW(train(data, stopped), Cancelled);
  const Sgpdm resumed = train(data, context);
  EXPECT_EQ(resumed.latents, whole.latents);
  EXPECT_EQ(resumed.trace, whole.trace);
  EXPECT_EQ(resumed.ended, "converged");
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

TEST(TrainSgpdm, LearnsWhateverTheUnits) {
  Context context;
  TrainSgpdm train;
  const StateData data = wavy(10, 4);
  const Sgpdm expected = train(data, context);
  StateData small = data, beside = data, uneven = data;
  for (std::size_t w = 0; w < 10; ++w) {
    small.audio[w] *= 1e-13;
    small.visual[w] *= 1e-100;
    beside.audio[w].conservativeResize(Eigen::NoChange, 9);
    beside.audio[w].col(8).setConstant(1e13);
    uneven.visual[w].col(2) *= 1e-9;
  }
  for (const auto& other : {small, beside, uneven}) {
    const Sgpdm model = train(other, context);
    EXPECT_GT(model.iterations, 0);
    EXPECT_LT(unexplained(model, other), 1.5 * unexplained(expected, data));
  }
  const Sgpdm model = train(uneven, context);
  EXPECT_NEAR(model.visual.scale[2] * 1e9, expected.visual.scale[2], 1e-9);
}

TEST(TrainSgpdm, SaysThatNothingVaries) {
  StateData constant = wavy(3, 2);
  for (auto& y : constant.audio) y.setConstant(0.1);
  for (auto& z : constant.visual) z.setConstant(-2);
  Context context;
  std::string warning;
  context.on_warning = [&](std::string_view text) { warning = text; };
  TrainSgpdm train;
  for (const auto scaling : {OutputScaling::per_dimension, OutputScaling::common}) {
    train.audio_scaling = train.visual_scaling = scaling;
    const Sgpdm model = train(constant, context);
    EXPECT_EQ(model.ended, "nothing varies");
    EXPECT_EQ(model.iterations, 0);
    EXPECT_TRUE(model.audio.scale.isOnes(0));
    EXPECT_EQ(warning, "state \"k-ae-t\": nothing varies in 6 frames: the model answers with their mean");
  }
  warning = "";
  EXPECT_NE(train(wavy(3, 2), context).ended, "nothing varies");
  EXPECT_EQ(warning, "");
}

TEST(TrainSgpdm, HasAsManyDimensionsAsAreAskedFor) {
  StateData data = wavy(10, 4);
  for (auto& z : data.visual) z = z.leftCols(1).eval();
  std::vector<std::string> warnings;
  Context context;
  context.on_warning = [&](std::string_view text) { warnings.emplace_back(text); };
  TrainSgpdm train;
  for (const auto initial : {LatentStart::pcca, LatentStart::ppca, LatentStart::cca}) {
    train.initial = initial;
    train.iterations = 0;
    const Eigen::MatrixXd x = train(data, context).latents;
    ASSERT_EQ(x.cols(), 3);
    EXPECT_GT(Eigen::JacobiSVD<Eigen::MatrixXd>(x).singularValues()[2], 0.1);
    train.iterations = 20;
    expect_usable(train(data, context));
  }
  EXPECT_TRUE(warnings.empty());
  train.latent_dimension = 9;
  EXPECT_EQ(train(data, context).latents.cols(), 8);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "state \"k-ae-t\": latent_dimension is 8 and not 9, as 40 frames of at most 8 dimensions have no more");
}

TEST(TrainSgpdm, LogsFewDigits) {
  StateData data = wavy(4, 3);
  for (auto& y : data.audio) y *= 1e90;
  Context context;
  std::string log;
  context.on_log = [&](std::string_view text) { log = text; };
  TrainSgpdm train;
  train.audio_scaling = OutputScaling::none;
  train.iterations = 0;
  train(data, context);
  EXPECT_NE(log.find("e+18"), std::string::npos) << log;
  EXPECT_LT(log.size(), 150u) << log;
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
    EXPECT_STREQ(e.what(),
                 "state \"k-ae-t\": frame 0 of audio window 1 has a value that is not finite; where values are missing "
                 "(NaN), latent.mrd learns from the others");
  }
  data = wavy(1, 3);
  data.visual[0].resize(3, 0);
  try {
    train(data, context);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "state \"k-ae-t\": window 0 has no visual dimensions");
  }
}

TEST(TrainSgpdm, RefusesAStartWhereOnlyDerivativesOverflow) {
  Context context;
  TrainSgpdm train;
  train.inducing = 5;
  train.noise = 1e-200;
  train.minimum_noise = 0;
  for (const auto kind : {OptimiserKind::scg, OptimiserKind::lbfgs}) {
    train.optimiser = kind;
    try {
      train(wavy(8, 4), context);
      FAIL();
    } catch (const FactorisationError& e) {
      EXPECT_EQ(std::string(e.what()).find("state \"k-ae-t\": the log-likelihood has derivatives that are not finite"),
                0u)
          << e.what();
    }
  }
}

TEST(TrainSgpdm, SaysWhatCanBeFixed) {
  Context context;
  TrainSgpdm train;
  train.fixed = {"visual.white", "audio.linear"};
  try {
    train(wavy(2, 3), context);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(
        e.what(),
        "\"audio.linear\" cannot be fixed: give some of latents, inducing, audio.rbf_variance, "
        "audio.inverse_width, audio.bias, audio.white, visual.rbf_variance, visual.inverse_width, visual.bias, "
        "visual.white, dynamics.rbf_variance, dynamics.inverse_width, dynamics.linear, dynamics.white");
  }
}

TEST(TrainSgpdm, FixesWhatDynamicsHaveWhetherThereAreAnyOrNot) {
  Context context;
  for (const auto form : {LatentDynamics::none, LatentDynamics::absolute}) {
    TrainSgpdm train;
    train.dynamics = form;
    train.fixed = {"dynamics.linear", "dynamics.white", "dynamics.rbf_variance", "dynamics.inverse_width"};
    expect_usable(train(wavy(2, 3), context));
    train.fixed = {"dynamics.foo"};
    EXPECT_THROW(train(wavy(2, 3), context), std::invalid_argument);
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
  for (const auto approximation : {CovarianceApproximation::full, CovarianceApproximation::fitc,
                                   CovarianceApproximation::pitc, CovarianceApproximation::variational})
    for (const auto dynamics : {LatentDynamics::none, LatentDynamics::absolute, LatentDynamics::difference,
                                LatentDynamics::time, LatentDynamics::phase}) {
      TrainSgpdm train;
      train.approximation = approximation;
      train.dynamics = dynamics;
      train.iterations = 10;
      train.inducing = 7;
      train.dynamics_inverse_width = 2;
      const Sgpdm model = train(data, context);
      const Eigen::MatrixXd audio = model.audio_frames.topRows(5) + 0.1 * gaussian(5, 8, 9);
      for (std::uint64_t draw = 0; draw < 100; ++draw) {
        SequenceObjective objective(model, audio, draw % 2);
        objective.follow(gaussian(1, 6, 4), draw % 3 ? 0.7 : 0);
        if (draw % 5 == 0) objective.see(gaussian(5, 6, 5));
        const auto check =
            check_gradient(objective, model.latents.topRows(5).reshaped() + 0.3 * gaussian(15, 1, draw).reshaped());
        EXPECT_TRUE(check.evaluated && check.cost_consistent);
        EXPECT_LT(check.worst, 1e-6) << check.report();
      }
    }
}

/// Eqn 4.78 of a model with exact processes, from the joint densities of training and new points.
TEST(SequenceObjective, IsTheConditionalOfTheJointDensity) {
  Context context;
  for (const auto form : {LatentDynamics::absolute, LatentDynamics::difference}) {
    TrainSgpdm train;
    train.dynamics = form;
    train.approximation = CovarianceApproximation::full;
    const StateData data = wavy(4, 5);
    Sgpdm model = train(data, context);
    Eigen::MatrixXd heard(20, 8);
    for (Eigen::Index w = 0; w < 4; ++w) heard.middleRows(5 * w, 5) = data.audio[static_cast<std::size_t>(w)];
    const Eigen::MatrixXd x = model.latents.middleRows(5, 4) + 0.1 * gaussian(4, 3, 1),
                          audio = model.audio_frames.middleRows(5, 4) + 0.1 * gaussian(4, 8, 2);
    const auto point_densities = [](const GaussianProcess& gp, const Eigen::MatrixXd& inputs,
                                    const Eigen::MatrixXd& outputs, const Eigen::MatrixXd& at,
                                    const Eigen::MatrixXd& y) {
      const Eigen::MatrixXd inverse = testing::textbook_inverse(testing::textbook_full(gp.kernel, inputs));
      double sum = 0;
      for (Eigen::Index t = 0; t < at.rows(); ++t) {
        const Eigen::MatrixXd k = testing::textbook_matrix(gp.kernel, at.row(t), inputs);
        const double variance = (testing::textbook_full(gp.kernel, at.row(t)) - k * inverse * k.transpose())(0, 0);
        const Eigen::MatrixXd apart = y.row(t) - k * inverse * outputs;
        sum += testing::textbook_density(Eigen::MatrixXd::Constant(1, 1, variance), apart);
      }
      return sum;
    };
    Eigen::MatrixXd in(16, 3), out(16, 3);
    for (Eigen::Index w = 0; w < 4; ++w) {
      in.middleRows(4 * w, 4) = model.latents.middleRows(5 * w, 4);
      out.middleRows(4 * w, 4) = model.latents.middleRows(5 * w + 1, 4);
    }
    Eigen::MatrixXd steps = x.bottomRows(3);
    if (form == LatentDynamics::difference) {
      out -= in;
      steps -= x.topRows(3);
    }
    FullLikelihood full;
    const Eigen::MatrixXd outputs = scaled(model.audio, heard), none(0, 3);
    model.audio = full.posterior(model.audio.kernel, model.latents, none, outputs);
    model.dynamics = full.posterior(model.dynamics->kernel, in, none, out);
    const double expected =
        point_densities(model.audio, model.latents, outputs, x, audio) +
        model.dynamics_bias *
            (point_densities(*model.dynamics, in, out, x.topRows(3), steps) +
             testing::textbook_density(Eigen::MatrixXd::Constant(1, 1, model.first_variance), x.topRows(1)));
    SequenceObjective objective(model, audio, true);
    double cost = 0;
    ASSERT_TRUE(objective.evaluate(x.reshaped(), cost, nullptr));
    EXPECT_NEAR(-cost, expected, 1e-9 * std::abs(expected) + 1e-9);
  }
}

/// Windows of any length that pass the same curve, from its beginning to its end.
StateData same_curve(const std::vector<int>& lengths) {
  const auto to_audio = gaussian(3, 8, 101), to_visual = gaussian(3, 6, 102);
  StateData data{"k-ae-t", {}, {}};
  for (const int length : lengths) {
    Eigen::MatrixXd basis(length, 3);
    for (int t = 0; t < length; ++t) {
      const double share = (t + 0.5) / length;
      basis.row(t) << share, std::sin(3 * share), std::cos(5 * share);
    }
    const auto seed = data.audio.size();
    data.audio.push_back(basis * to_audio + 0.02 * gaussian(length, 8, 1000 + seed));
    data.visual.push_back(basis * to_visual + 0.02 * gaussian(length, 6, 2000 + seed));
  }
  return data;
}

// Windows of 3 to 9 frames: where the share of the window says all, the dynamics find the points of each, which
// points before cannot, as steps are of any size.
TEST(TrainSgpdm, DynamicsOfPhaseKnowWhereWindowsOfAnyLengthAre) {
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.iterations = 60;
  train.prior_deviation = 0;
  train.dynamics = LatentDynamics::phase;
  train.dynamics_inverse_width = 10;
  const Sgpdm model = train(same_curve({3, 9, 5, 7, 4, 8, 6, 3, 9}), context);
  ASSERT_TRUE(model.dynamics);
  EXPECT_EQ(model.form, DynamicsForm::phase);
  Predictive h;
  h.compute(*model.dynamics, times_of(model.lengths, model.form));
  EXPECT_LT((h.mean() - model.latents).squaredNorm(), 0.02 * model.latents.squaredNorm());
  EXPECT_LT(unexplained(model, same_curve({3, 9, 5, 7, 4, 8, 6, 3, 9})), 0.02);
}

TEST(TrainSgpdm, OfOneFrameWindowsHasNoDynamicsOfTimeEither) {
  Context context;
  TrainSgpdm train;
  train.dynamics = LatentDynamics::time;
  const Sgpdm model = train(wavy(12, 1), context);
  EXPECT_FALSE(model.dynamics);
  EXPECT_EQ(model.first_variance, train.first_variance);
}

TEST(TrainSgpdm, InTimeTakesFewInducingPointsOfManyFrames) {
  Context context;
  TrainSgpdm train;
  train.dynamics = LatentDynamics::phase;
  train.dynamics_inverse_width = 10;
  train.iterations = 5;
  train.inducing = 50;
  const Sgpdm model = train(wavy(40, 6), context);
  EXPECT_EQ(model.dynamics->basis.cols(), 1);
  EXPECT_LE(model.dynamics->basis.rows(), 8);
  EXPECT_EQ(model.audio.basis.rows(), 50);
  Sgpdm saved = model, loaded;
  const test::TemporaryFolder folder;
  const auto path = folder.file("sgpdm.h5");
  write_hdf5(path, [&](Archive& ar) { fields(ar, saved); });
  fields(*hdf5_reader(path), loaded);
  EXPECT_EQ(loaded.form, DynamicsForm::phase);
  EXPECT_EQ(loaded.dynamics->basis, model.dynamics->basis);
}

TEST(Clock, SaysWhenFramesAre) {
  const std::vector<std::int64_t> lengths = {2, 1, 4};
  EXPECT_EQ(times_of(lengths, DynamicsForm::time).transpose(),
            (Eigen::RowVectorXd(7) << 0, 1, 0, 0, 1, 2, 3).finished());
  EXPECT_TRUE(times_of(lengths, DynamicsForm::phase)
                  .transpose()
                  .isApprox((Eigen::RowVectorXd(7) << 0.25, 0.75, 0.5, 0.125, 0.375, 0.625, 0.875).finished()));
  const Eigen::MatrixXd spread = spread_times(times_of(lengths, DynamicsForm::time), 1, 100);
  EXPECT_EQ(spread.rows(), 7) << "half a frame apart from 0 to 3";
  EXPECT_EQ(spread(6, 0), 3);
  EXPECT_EQ(spread_times(times_of(lengths, DynamicsForm::time), 1, 3).rows(), 3);
  EXPECT_EQ(spread_times(Eigen::MatrixXd::Constant(5, 1, 0.5), 1, 3).rows(), 1);
}

TEST(Compacted, KeepsPredictionsAndTakesNothingWhereItCannot) {
  const auto x = gaussian(40, 3, 1), at = gaussian(10, 3, 2);
  const Eigen::MatrixXd y = (x * gaussian(3, 5, 3)).array().sin();
  FullLikelihood full;
  for (const double noise : {0.3, 1e-3, 1e-9}) {
    const Kernel kernel{{RbfTerm{1, 0.5}, WhiteTerm{noise}}};
    const GaussianProcess before = full.posterior(kernel, x, x, y), after = compacted(before, x);
    EXPECT_TRUE(after.root.isLowerTriangular(0));
    EXPECT_TRUE((after.root * after.root.transpose()).isApprox(before.root * before.root.transpose(), 1e-4));
    const bool noisy = noise == 0.3, precise = noise == 1e-9;
    EXPECT_TRUE(!noisy || after.weights == rounded(before.weights, 16));
    EXPECT_TRUE(!precise || after.weights == before.weights);
    Predictive p, q;
    p.compute(before, at);
    q.compute(after, at);
    EXPECT_TRUE(((p.variance() - q.variance()).array().abs() <= 1e-3 * p.variance().array()).all()) << noise;
    EXPECT_TRUE(((p.mean() - q.mean()).array().abs().rowwise().maxCoeff() <= 1e-3 * p.variance().array().sqrt()).all());
  }
  const auto one = [](double v, int bits) { return rounded(Eigen::MatrixXd::Constant(1, 1, v), bits)(0, 0); };
  EXPECT_EQ(one(1 + 1e-7, 20), 1);
  EXPECT_EQ(one(1.75, 1), 2);
  EXPECT_EQ(one(-1.5, 1), -1.5);
  EXPECT_NEAR(one(-0.1, 20), -0.1, 0.1 * 5e-7);
}

}  // namespace
}  // namespace talkgraph
