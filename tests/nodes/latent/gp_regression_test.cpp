#include "nodes/latent/gp_regression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

#include "nodes/latent/gp_objective.h"
#include "tests/nodes/latent/likelihoods.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Track track(Eigen::MatrixXd values) { return {std::move(values), Rational(25), 0.02, {}}; }

/// Visual parameters as smooth functions of the sound at the same frame, with noise of deviation 0.1.
struct Pairs {
  Collected<Track> audio, visual;
  explicit Pairs(int sequences, int frames = 40, double noise = 0.1) {
    for (int s = 0; s < sequences; ++s) {
      const auto seed = static_cast<std::uint64_t>(s);
      const auto sound = gaussian(frames, 2, 100 + seed);
      audio.add(std::to_string(s), track(sound));
      visual.add(std::to_string(s), track(truth(sound) + noise * gaussian(frames, 3, 200 + seed)));
    }
  }
  static Eigen::MatrixXd truth(const Eigen::MatrixXd& x) {
    Eigen::MatrixXd y(x.rows(), 3);
    y.col(0) = x.col(0).array().sin();
    y.col(1) = 100 + 10 * x.col(0).cwiseProduct(x.col(1)).array();
    y.col(2) = 0.5 * x.col(1).array().cos();
    return y;
  }
};

TrainGp trainer(CovarianceApproximation approximation) {
  TrainGp train;
  train.context = 0;
  train.approximation = approximation;
  train.inducing = 40;
  return train;
}

TEST(GpRegression, LearnsASmoothFunctionByEveryApproximation) {
  const Pairs pairs(5, 40, 0);
  const Eigen::MatrixXd sound = 0.8 * gaussian(200, 2, 7);
  Context context;
  for (const auto& [approximation, name] :
       std::map<CovarianceApproximation, std::string>{{CovarianceApproximation::full, "full"},
                                                      {CovarianceApproximation::dtc, "DTC"},
                                                      {CovarianceApproximation::fitc, "FITC"},
                                                      {CovarianceApproximation::pitc, "PITC"},
                                                      {CovarianceApproximation::variational, "variational"}}) {
    const GpRegression model = trainer(approximation)(pairs.audio, pairs.visual, context);
    EXPECT_EQ(model.process.basis.rows(), approximation == CovarianceApproximation::full ? 200 : 40);
    const auto [mean, deviation] = PredictGp{}(model, track(sound));
    const Eigen::MatrixXd error = mean.values - Pairs::truth(sound);
    const Eigen::RowVectorXd spread = Eigen::RowVector3d(0.7, 10, 0.3);
    EXPECT_LT((error.array().rowwise() / spread.array()).abs2().mean(), 0.02) << name;
    EXPECT_TRUE((deviation.values.array() > 0).all()) << name;
    EXPECT_EQ(mean.start, 0.02);
    EXPECT_EQ(deviation.frames(), 200);
  }
}

TEST(GpRegression, DeviationIsThatOfTheErrors) {
  const Pairs pairs(10), unseen(10 + 3);
  Context context;
  const GpRegression model = trainer(CovarianceApproximation::fitc)(pairs.audio, pairs.visual, context);
  double sum = 0;
  for (std::size_t s = 10; s < 13; ++s) {
    const auto [mean, deviation] = PredictGp{}(model, unseen.audio[s]);
    sum += ((unseen.visual[s].values - mean.values).array() / deviation.values.array()).abs2().mean() / 3;
  }
  EXPECT_NEAR(sum, 1, 0.5);
}

TEST(GpRegression, LogLikelihoodIsADensityOfTheFramesThemselves) {
  const Pairs pairs(1, 30);
  TrainGp train = trainer(CovarianceApproximation::full);
  train.iterations = 0;
  train.kernel = {{KernelKind::rbf, 1, 0.8, 0}, {KernelKind::white, 0.3, 1, 0}};
  Context context;
  const GpRegression model = train(pairs.audio, pairs.visual, context);
  const auto& x = model.process.basis;
  const Kernel kernel{{RbfTerm{1, 0.8}, WhiteTerm{0.3}}};
  double expected = 0;
  for (int c = 0; c < 3; ++c) {
    const double scale = model.process.scale[c];
    expected += testing::textbook_density(scale * scale * testing::textbook_full(kernel, x),
                                          pairs.visual[0].values.col(c).array() - model.process.mean[c]);
  }
  EXPECT_NEAR(model.log_likelihood, expected, 1e-9 * std::abs(expected));
}

TEST(GpRegression, WidthsOfItsOwnFindTheDimensionThatMatters) {
  Collected<Track> audio, visual;
  const auto sound = gaussian(150, 3, 1);
  audio.add("a", track(sound));
  visual.add("a", track((2 * sound.col(1)).array().sin().matrix()));
  TrainGp train = trainer(CovarianceApproximation::full);
  train.kernel = {{KernelKind::ard, 1, 1, 0}, {KernelKind::white, 0.1, 1, 1e-4}};
  Context context;
  for (const auto kind : {OptimiserKind::scg, OptimiserKind::lbfgs}) {
    train.optimiser = kind;
    const auto widths = std::get<ArdTerm>(train(audio, visual, context).process.kernel.terms[0]).inverse_widths;
    EXPECT_GT(widths[1], 30 * widths[0]);
    EXPECT_GT(widths[1], 30 * widths[2]);
  }
}

TEST(GpRegression, InducingPointsStayWhereTheyAreFixed) {
  const Pairs pairs(4);
  TrainGp train = trainer(CovarianceApproximation::fitc);
  train.inducing = 10;
  train.fix_inducing = true;
  Context context;
  const GpRegression fixed = train(pairs.audio, pairs.visual, context);
  for (Eigen::Index i = 0; i < 10; ++i) {
    const Eigen::RowVectorXd frame = pairs.audio[static_cast<std::size_t>(i * 16 / 40)].values.row(i * 16 % 40);
    EXPECT_TRUE(
        fixed.process.basis.row(i).isApprox((frame - fixed.inputs.mean).cwiseProduct(fixed.inputs.scale), 1e-12));
  }
  train.fix_inducing = false;
  EXPECT_GT(train(pairs.audio, pairs.visual, context).log_likelihood, fixed.log_likelihood);
}

TEST(GpRegression, HoldsTheNoiseInTheFirstIterations) {
  const Pairs pairs(2);
  TrainGp train = trainer(CovarianceApproximation::fitc);
  train.iterations = train.hold_noise = 10;
  Context context;
  const GpRegression held = train(pairs.audio, pairs.visual, context);
  EXPECT_NEAR(white_variance(held.process.kernel), 0.5, 1e-6);
  EXPECT_EQ(held.trace.size(), 11u);
  train.iterations = 20;
  const GpRegression let_go = train(pairs.audio, pairs.visual, context);
  EXPECT_LT(white_variance(let_go.process.kernel), 0.49);
  EXPECT_GT(let_go.log_likelihood, held.log_likelihood);
}

TEST(GpRegression, TracesItsLikelihoodAndSaysWhyItEnded) {
  const Pairs pairs(2);
  TrainGp train = trainer(CovarianceApproximation::fitc);
  train.iterations = 5;
  Context context;
  const GpRegression model = train(pairs.audio, pairs.visual, context);
  EXPECT_EQ(model.frames, 80);
  EXPECT_EQ(model.ended, "iteration limit");
  ASSERT_EQ(model.trace.size(), 6u);
  EXPECT_EQ(model.trace.back(), model.log_likelihood);
  EXPECT_TRUE(std::is_sorted(model.trace.begin(), model.trace.end()));
  train.iterations = 1000000;
  train.time_limit = 0.05;
  const GpRegression short_of_time = train(pairs.audio, pairs.visual, context);
  EXPECT_GT(short_of_time.iterations, 0);
  EXPECT_LT(short_of_time.iterations, 100000);
}

TEST(GpRegression, GoesOnWhereItWasStopped) {
  const Pairs pairs(2);
  const test::TemporaryFolder folder;
  TrainGp train = trainer(CovarianceApproximation::fitc);
  train.iterations = 20;
  train.hold_noise = 5;
  Context context;
  const GpRegression whole = train(pairs.audio, pairs.visual, context);
  train.checkpoint = folder.file("checkpoints");
  std::atomic<bool> cancel = false;
  Context stopped;
  stopped.cancel = &cancel;
  stopped.on_progress = [&](double share) { cancel = share >= 0.5; };
  EXPECT_THROW(train(pairs.audio, pairs.visual, stopped), Cancelled);
  EXPECT_FALSE(std::filesystem::is_empty(train.checkpoint));
  const GpRegression resumed = train(pairs.audio, pairs.visual, context);
  EXPECT_EQ(resumed.trace, whole.trace);
  EXPECT_EQ(resumed.process.weights, whole.process.weights);
  EXPECT_TRUE(std::filesystem::is_empty(train.checkpoint));
}

TEST(GpObjective, NamesItsParametersAndItsGradientAgreesWithDifferences) {
  const auto x = gaussian(20, 2, 1), y = gaussian(20, 3, 2);
  const Kernel kernel{{ArdTerm{1, Eigen::Vector2d(1, 2)}, WhiteTerm{0.1}}};
  for (const bool fixed : {false, true}) {
    FitcLikelihood fitc;
    GpObjective objective(fitc, kernel, x, 2 * gaussian(4, 2, 3), fixed, y);
    ASSERT_EQ(objective.size(), fixed ? 4 : 12);
    EXPECT_EQ(objective.name(objective.size() - 2), "log inverse_width_2");
    const auto check = check_gradient(objective, objective.start());
    EXPECT_LT(check.worst, 1e-7) << check.report();
  }
}

TEST(GpRegression, AnswersDegenerateData) {
  Context context;
  const TrainGp train;
  const auto usable = [&](const Collected<Track>& audio, const Collected<Track>& visual) {
    const auto [mean, deviation] = PredictGp{}(train(audio, visual, context), audio[0]);
    EXPECT_TRUE(mean.values.allFinite() && deviation.values.allFinite());
    EXPECT_TRUE((deviation.values.array() > 0).all());
    return mean.values;
  };
  Collected<Track> one{{"a", track(gaussian(1, 2, 1))}}, still{{"a", track(Eigen::MatrixXd::Constant(5, 2, 3.0))}};
  EXPECT_TRUE(usable(one, one).isApprox(one[0].values, 1e-9));
  EXPECT_TRUE(usable(still, still).isApproxToConstant(3, 1e-9));
  const Pairs pairs(4);
  usable(still, still);
  for (const double scale : {1e-150, 1e150}) {
    Collected<Track> audio, visual;
    for (std::size_t i = 0; i < 4; ++i) {
      audio.add(pairs.audio.key(i), track(pairs.audio[i].values * scale));
      visual.add(pairs.audio.key(i), track(pairs.visual[i].values * scale));
    }
    usable(audio, visual);
  }
}

TEST(GpRegression, RefusesStreamsWithoutDimensions) {
  Context context;
  const Collected<Track> some{{"0", track(gaussian(80, 2, 1))}}, none{{"0", track(Eigen::MatrixXd(80, 0))}};
  for (const auto& [audio, visual] : {std::pair(some, none), std::pair(none, some)})
    for (const int inducing : {20, 100}) {
      TrainGp train;
      train.inducing = inducing;
      EXPECT_THROW(train(audio, visual, context), std::runtime_error);
    }
}

TEST(GpRegression, RefusesAKernelOfNoiseAlone) {
  Context context;
  const Pairs pairs(2);
  TrainGp train;
  for (const auto& kernel : {std::vector<KernelChoice>{}, {{KernelKind::white, 0.5, 1, 1e-3}}}) {
    train.kernel = kernel;
    try {
      train(pairs.audio, pairs.visual, context);
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("term besides white"), std::string::npos) << e.what();
    }
  }
}

TEST(PredictGp, KeepsLostFramesMarked) {
  Context context;
  const Pairs pairs(2);
  Track sound = pairs.audio[0];
  sound.lost = {3, 4};
  const auto given = PredictGp{}(TrainGp{}(pairs.audio, pairs.visual, context), sound);
  EXPECT_EQ(given.track.lost, sound.lost);
  EXPECT_EQ(given.deviation.lost, sound.lost);
}

TEST(GpRegression, RefusesWhatItCannotLearnFrom) {
  Context context;
  Pairs pairs(2);
  EXPECT_THROW(TrainGp{}({}, {}, context), std::runtime_error);
  Track broken = pairs.audio[0];
  broken.values(3, 1) = std::nan("");
  EXPECT_THROW(TrainGp{}({{"0", broken}}, pairs.visual, context), std::runtime_error);
  TrainGp silent;
  silent.inducing = 10;
  silent.approximation = CovarianceApproximation::dtc;
  silent.kernel = {{KernelKind::rbf, 1, 1, 0}};
  EXPECT_THROW(silent(pairs.audio, pairs.visual, context), FactorisationError);
  silent.approximation = CovarianceApproximation::fitc;
  silent.kernel.push_back({KernelKind::white, 1e-200, 1, 0});
  EXPECT_THROW(silent(pairs.audio, pairs.visual, context), FactorisationError);
  silent.kernel = {};
  EXPECT_THROW(silent(pairs.audio, pairs.visual, context), std::runtime_error);
  const GpRegression model = TrainGp{}(pairs.audio, pairs.visual, context);
  EXPECT_THROW(PredictGp{}(model, track(gaussian(5, 3, 1))), std::runtime_error);
  std::atomic<bool> cancel = true;
  context.cancel = &cancel;
  EXPECT_THROW(TrainGp{}(pairs.audio, pairs.visual, context), Cancelled);
}

}  // namespace
}  // namespace talkgraph
