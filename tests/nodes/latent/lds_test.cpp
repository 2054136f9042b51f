#include "nodes/latent/lds.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::positive;

/// A damped rotation, seen in four dimensions.
Lds truth() {
  Lds model;
  model.prediction.resize(2, 2);
  model.prediction << std::cos(0.4), -std::sin(0.4), std::sin(0.4), std::cos(0.4);
  model.prediction *= 0.95;
  model.offset = Eigen::Vector2d(0.1, -0.2);
  model.prediction_noise = 0.1 * positive(2, 1);
  model.first_mean = Eigen::Vector2d(1, 2);
  model.first_covariance = positive(2, 2);
  model.mean = gaussian(1, 4, 3);
  model.observation = gaussian(4, 2, 4);
  model.observation_noise = 0.2 * positive(4, 5);
  return model;
}

Sequences sample(const Lds& model, const std::vector<std::int64_t>& lengths, std::uint64_t seed) {
  const auto noise = [](const Eigen::MatrixXd& covariance, std::uint64_t from) -> Eigen::VectorXd {
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    return root * gaussian(covariance.rows(), 1, from);
  };
  Sequences s{Eigen::MatrixXd(0, model.dimension()), lengths};
  for (const auto length : lengths) {
    Eigen::VectorXd x = model.first_mean + noise(model.first_covariance, ++seed);
    for (std::int64_t t = 0; t < length; ++t) {
      if (t > 0) x = (model.prediction * x + model.offset + noise(model.prediction_noise, ++seed)).eval();
      s.frames.conservativeResize(s.frames.rows() + 1, Eigen::NoChange);
      s.frames.bottomRows(1) =
          model.mean + (model.observation * x + noise(model.observation_noise, ++seed)).transpose();
    }
  }
  return s;
}

/// The joint Gaussian of all states and all frames of a sequence, built block by block.
struct Joint {
  Joint(const Lds& m, Eigen::Index frames) : Joint(LdsRegimes(static_cast<std::size_t>(frames), &m)) {}
  explicit Joint(const LdsRegimes& regimes) : d(regimes[0]->states()), dims(regimes[0]->dimension()) {
    const auto frames = static_cast<Eigen::Index>(regimes.size());
    mean.resize(frames * d);
    covariance.resize(frames * d, frames * d);
    mean.head(d) = regimes[0]->first_mean;
    covariance.topLeftCorner(d, d) = regimes[0]->first_covariance;
    for (Eigen::Index t = 1; t < frames; ++t) {
      const Lds& m = *regimes[static_cast<std::size_t>(t)];
      mean.segment(t * d, d) = m.prediction * mean.segment((t - 1) * d, d) + m.offset;
      const Eigen::MatrixXd across = m.prediction * covariance.block((t - 1) * d, 0, d, t * d);
      covariance.block(t * d, 0, d, t * d) = across;
      covariance.block(0, t * d, t * d, d) = across.transpose();
      covariance.block(t * d, t * d, d, d) = across.rightCols(d) * m.prediction.transpose() + m.prediction_noise;
    }
    observe.setZero(frames * dims, frames * d);
    noise.setZero(frames * dims, frames * dims);
    observed_mean.resize(frames * dims);
    for (Eigen::Index t = 0; t < frames; ++t) {
      const Lds& m = *regimes[static_cast<std::size_t>(t)];
      observe.block(t * dims, t * d, dims, d) = m.observation;
      noise.block(t * dims, t * dims, dims, dims) = m.observation_noise.cols() == 1
                                                        ? Eigen::MatrixXd(m.observation_noise.col(0).asDiagonal())
                                                        : m.observation_noise;
      observed_mean.segment(t * dims, dims) = m.mean.transpose();
    }
    observed_mean += observe * mean;
  }

  /// Conditions states on the frames that are kept.
  void condition(const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < frames.rows(); ++t)
      if (!std::binary_search(lost.begin(), lost.end(), t))
        for (Eigen::Index i = 0; i < dims; ++i) kept.push_back(t * dims + i);
    if (kept.empty()) return;
    const Eigen::MatrixXd rows = frames.transpose();
    const Eigen::VectorXd y = rows.reshaped()(kept), expected = observed_mean(kept);
    const Eigen::MatrixXd map = observe(kept, Eigen::all);
    const Eigen::MatrixXd marginal = map * covariance * map.transpose() + noise(kept, kept);
    log_likelihood = testing::log_normal_density(y, expected, marginal);
    const Eigen::MatrixXd gain = covariance * map.transpose() * marginal.inverse();
    mean += gain * (y - expected);
    covariance -= gain * map * covariance;
  }

  Eigen::Index d, dims;
  Eigen::VectorXd mean, observed_mean;
  Eigen::MatrixXd covariance, observe, noise;
  double log_likelihood = 0;
};

void expect_dense(const LdsRegimes& regimes, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  const Eigen::Index length = frames.rows(), d = regimes[0]->states();
  const LdsPosterior smoothed = kalman_smoother(regimes, frames, lost), filtered = kalman_filter(regimes, frames, lost);
  Joint joint(regimes);
  joint.condition(frames, lost);
  EXPECT_NEAR(smoothed.log_likelihood, joint.log_likelihood, 1e-9);
  EXPECT_EQ(filtered.log_likelihood, smoothed.log_likelihood);
  for (Eigen::Index t = 0; t < length; ++t) {
    const auto at = static_cast<std::size_t>(t);
    EXPECT_LT((smoothed.means.row(t).transpose() - joint.mean.segment(t * d, d)).norm(), 1e-9);
    EXPECT_LT((smoothed.covariances[at] - joint.covariance.block(t * d, t * d, d, d)).norm(), 1e-9);
    if (t > 0) {
      EXPECT_LT((smoothed.lagged[at - 1] - joint.covariance.block(t * d, (t - 1) * d, d, d)).norm(), 1e-9);
    }

    Joint so_far(LdsRegimes(regimes.begin(), regimes.begin() + t + 1));
    std::vector<std::int64_t> lost_so_far;
    for (const auto l : lost)
      if (l <= t) lost_so_far.push_back(l);
    so_far.condition(frames.topRows(t + 1), lost_so_far);
    EXPECT_LT((filtered.means.row(t).transpose() - so_far.mean.tail(d)).norm(), 1e-9);
    EXPECT_LT((filtered.covariances[at] - so_far.covariance.bottomRightCorner(d, d)).norm(), 1e-9);
  }
}

void expect_dense(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  expect_dense(LdsRegimes(static_cast<std::size_t>(frames.rows()), &model), frames, lost);
  EXPECT_EQ(kalman_smoother(model, frames, lost).log_likelihood, kalman_filter(model, frames, lost).log_likelihood);
}

TEST(Lds, FilterSmootherAndLikelihoodAreThoseOfTheJointGaussian) {
  Lds model = truth();
  for (const std::int64_t length : {1, 2, 8}) expect_dense(model, sample(model, {length}, 1).frames, {});
  expect_dense(model, sample(model, {8}, 2).frames, {0, 3, 4, 7});
  expect_dense(model, 100 * sample(model, {5}, 2).frames, {});
  const Eigen::MatrixXd frames = sample(model, {8}, 3).frames;
  model.observation_noise = model.observation_noise.diagonal().eval();
  expect_dense(model, frames, {2});
}

TEST(Lds, AlsoWhereTheSystemSwitches) {
  const Lds one = truth();
  Lds other = one;
  other.prediction *= -0.5;
  other.offset *= 3;
  other.prediction_noise *= 2;
  other.first_mean *= -1;
  other.observation = gaussian(4, 2, 11);
  other.observation_noise = one.observation_noise.diagonal();
  other.mean = gaussian(1, 4, 12);
  const Eigen::MatrixXd frames = sample(one, {6}, 4).frames;
  expect_dense({&one, &one, &other, &one, &other, &other}, frames, {});
  expect_dense({&other, &one, &other, &other, &one, &one}, frames, {1, 4});
}

TEST(Lds, SmoothsManySequencesAsEachOne) {
  const Lds model = truth();
  const std::vector<Eigen::Index> lengths = {3, 8, 1, 8, 5, 3};
  const Sequences data = sample(model, {3, 8, 1, 8, 5, 3}, 6);
  LdsSmoother smooth(model);
  Eigen::Index from = 0;
  for (const auto length : lengths) {
    const Eigen::MatrixXd frames = data.frames.middleRows(from, length);
    const LdsPosterior alone = kalman_smoother(model, frames), beside = smooth(frames);
    EXPECT_EQ(beside.means, alone.means);
    EXPECT_EQ(beside.covariances, alone.covariances);
    EXPECT_EQ(beside.lagged, alone.lagged);
    EXPECT_EQ(beside.log_likelihood, alone.log_likelihood);
    from += length;
  }
}

TEST(Lds, OfAPartOfTheObservedDimensionsSeesTheSameStates) {
  Lds model = truth();
  model.observation_noise.topRightCorner(3, 1).setZero();
  model.observation_noise.bottomLeftCorner(1, 3).setZero();
  const Eigen::MatrixXd frames = sample(model, {8}, 4).frames;
  expect_dense(observed_part(model, 0, 3), frames.leftCols(3), {});
  model.observation_noise = model.observation_noise.diagonal().eval();
  expect_dense(observed_part(model, 1, 3), frames.rightCols(3), {});
  EXPECT_TRUE(observations(observed_part(model, 1, 3), gaussian(5, 2, 1))
                  .isApprox(observations(model, gaussian(5, 2, 1)).rightCols(3)));
}

TEST(Lds, CovariancesStayPositiveWithHardlyAnyNoise) {
  Lds model = truth();
  model.observation_noise *= 1e-14;
  model.prediction_noise *= 1e-9;
  const Eigen::MatrixXd frames = sample(model, {2000}, 1).frames;
  const LdsPosterior p = kalman_smoother(model, frames);
  EXPECT_TRUE(std::isfinite(p.log_likelihood));
  for (const Eigen::MatrixXd& c : p.covariances) EXPECT_GE(c.selfadjointView<Eigen::Lower>().eigenvalues()(0), 0);
  EXPECT_LT((observations(model, p.means) - frames).cwiseAbs().maxCoeff(), 1e-5);
}

double log_likelihood(const Lds& model, const Sequences& data) {
  double sum = 0;
  Eigen::Index from = 0;
  for (const auto length : data.lengths) {
    sum += kalman_filter(model, data.frames.middleRows(from, length)).log_likelihood;
    from += length;
  }
  return sum;
}

/// One of both that a system of two states learns from one sequence.
std::complex<double> pole_of_two_states(const Eigen::MatrixXd& frames) {
  Context context;
  TrainLds train;
  train.latent_dimension = 2;
  return train.fit({frames, {frames.rows()}}, context).prediction.eigenvalues()(0);
}

// Standardised principal components: no direction has more variance than another.
TEST(Lds, SeesMovementInWhiteComponents) {
  Eigen::MatrixXd frames = gaussian(300, 4, 1);
  for (Eigen::Index t = 0; t < 300; ++t) {
    frames(t, 0) += 5 * std::sin(0.5 * static_cast<double>(t));
    frames(t, 1) += 5 * std::cos(0.5 * static_cast<double>(t));
  }
  frames.rowwise() -= frames.colwise().mean().eval();
  const Eigen::LLT<Eigen::MatrixXd> root(frames.transpose() * frames / 300);
  frames = root.matrixL().solve(frames.transpose()).transpose().eval();
  const auto pole = pole_of_two_states(frames);
  EXPECT_NEAR(std::abs(std::arg(pole)), 0.5, 0.01);
  EXPECT_GT(std::abs(pole), 0.95);
}

TEST(Lds, RecoversTheSystemItsDataWereDrawnFrom) {
  const Lds model = truth();
  const Sequences data = sample(model, std::vector<std::int64_t>(40, 100), 1);
  Context context;
  TrainLds train;
  train.latent_dimension = 2;
  train.iterations = 400;
  train.tolerance = 1e-7;
  const Lds found = train.fit(data, context);
  EXPECT_GT(log_likelihood(found, data), log_likelihood(model, data));
  const Sequences unseen = sample(model, std::vector<std::int64_t>(20, 100), 100000);
  EXPECT_NEAR(log_likelihood(found, unseen), log_likelihood(model, unseen), 0.01 * 2000);
  // States are known up to a linear map: eigenvalues and what is observed are not.
  const auto eigenvalue = [](const Lds& m) { return m.prediction.eigenvalues()(0); };
  EXPECT_NEAR(std::abs(eigenvalue(found)), 0.95, 0.01);
  EXPECT_NEAR(std::abs(std::arg(eigenvalue(found))), 0.4, 0.02);
  EXPECT_TRUE(found.observation_noise.isApprox(model.observation_noise, 0.1));
  const auto moved = [](const Lds& m) -> Eigen::MatrixXd {
    return m.observation * m.prediction_noise * m.observation.transpose();
  };
  EXPECT_TRUE(moved(found).isApprox(moved(model), 0.15));
  const auto first = [](const Lds& m) -> Eigen::VectorXd { return m.mean.transpose() + m.observation * m.first_mean; };
  EXPECT_LT((first(found) - first(model)).norm(), 1);
}

TEST(Lds, LikelihoodNeverFalls) {
  Context context;
  for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal})
    for (const double floor : {1e-5, 1e-2})
      for (const int d : {1, 3, 6})
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
          Sequences data = sample(truth(), {1, 30, 2, 17}, 1000 * seed);
          data.frames.col(1) *= 1e4;
          data.frames.col(2).setConstant(1e3);
          TrainLds train{d, kind, floor, 1e-6, 80, 0};
          const Lds model = train.fit(data, context);
          EXPECT_GT(model.trace.size(), 3U);
          EXPECT_LT(testing::largest_fall(model.trace), 1e-10) << "d = " << d << ", seed " << seed;
          EXPECT_NEAR(model.trace.back(), log_likelihood(model, data), 1e-9 * std::abs(model.trace.back()));
        }
}

TEST(Lds, MoreStatesThanDimensionsSeeAnOscillation) {
  Eigen::MatrixXd frames(300, 1);
  for (Eigen::Index t = 0; t < 300; ++t) frames(t, 0) = 5 + std::sin(0.5 * static_cast<double>(t));
  frames += 0.05 * gaussian(300, 1, 1);
  const auto pole = pole_of_two_states(frames);
  EXPECT_NEAR(std::abs(std::arg(pole)), 0.5, 0.01);
  EXPECT_NEAR(std::abs(pole), 1, 0.01);
}

TEST(Lds, AnswersDegenerateData) {
  Context context;
  const auto fit = [&](const Eigen::MatrixXd& frames, std::vector<std::int64_t> lengths) {
    Lds model = TrainLds{}.fit({frames, std::move(lengths)}, context);
    const LdsPosterior p = kalman_smoother(model, frames);
    EXPECT_TRUE(std::isfinite(p.log_likelihood));
    EXPECT_TRUE(p.means.allFinite());
    return model;
  };
  fit(gaussian(1, 3, 1), {1});
  EXPECT_TRUE(fit(gaussian(5, 3, 1), {1, 1, 1, 1, 1}).prediction.isZero());
  fit(gaussian(3, 20, 1), {3});
  fit(gaussian(2, 2, 1).replicate(4, 1), {4, 4});
  const Lds still = fit(Eigen::MatrixXd::Constant(6, 2, 0.3), {6});
  EXPECT_TRUE(observations(still, kalman_smoother(still, Eigen::MatrixXd::Constant(6, 2, 0.3)).means)
                  .isApproxToConstant(0.3, 1e-9));
  fit(1e-120 * gaussian(9, 2, 1), {9});
  fit(1e100 * gaussian(9, 2, 1), {9});
  Lds broken = truth();
  broken.observation_noise.setZero();
  EXPECT_THROW(kalman_filter(broken, gaussian(2, 4, 1)), std::runtime_error);
  broken.observation_noise = Eigen::MatrixXd::Zero(4, 1);
  EXPECT_THROW(kalman_filter(broken, gaussian(2, 4, 1)), std::runtime_error);
}

TEST(LdsFilter, StepByStepIsTheKalmanFilter) {
  const Lds one = truth();
  Lds other = one;
  other.prediction *= -0.5;
  other.observation *= 2;
  const Eigen::MatrixXd frames = sample(one, {8}, 1).frames;
  const LdsRegimes regimes{&one, &other, &other, &one, &one, &other, &one, &one};
  const std::vector<std::int64_t> lost{0, 4};
  const LdsPosterior whole = kalman_filter(regimes, frames, lost);
  const LdsFilter of_one(one), of_other(other);
  LdsBelief belief;
  double log_likelihood = 0;
  for (Eigen::Index t = 0; t < 8; ++t) {
    const Eigen::RowVectorXd frame = frames.row(t);
    const LdsFilter& filter = regimes[static_cast<std::size_t>(t)] == &one ? of_one : of_other;
    belief = filter(t == 0 ? nullptr : &belief, t == 0 || t == 4 ? nullptr : &frame);
    log_likelihood += belief.log_likelihood;
    EXPECT_LT((belief.mean - whole.means.row(t).transpose()).norm(), 1e-12);
    EXPECT_LT((belief.covariance - whole.covariances[static_cast<std::size_t>(t)]).norm(), 1e-12);
  }
  EXPECT_NEAR(log_likelihood, whole.log_likelihood, 1e-9);
}

TEST(SmoothLds, DenoisesATrackAndBridgesLostFrames) {
  Lds model = truth();
  Track track;
  track.values = sample(model, {60}, 1).frames;
  track.values.row(20).setConstant(1e6);
  track.lost = {20};
  Context context;
  const auto smoothed = SmoothLds{}(model, track, context), filtered = SmoothLds{false}(model, track, context);
  EXPECT_EQ(smoothed.states.values, kalman_smoother(model, track.values, track.lost).means);
  EXPECT_EQ(filtered.states.values, kalman_filter(model, track.values, track.lost).means);
  EXPECT_EQ(smoothed.track.values, observations(model, smoothed.states.values));
  EXPECT_LT(smoothed.track.values.cwiseAbs().maxCoeff(), 50);
  EXPECT_EQ(smoothed.track.lost, track.lost);
  track.values(3, 0) = NAN;
  EXPECT_THROW(SmoothLds{}(model, track, context), std::runtime_error);
  track.values.resize(3, 5);
  EXPECT_THROW(SmoothLds{}(model, track, context), std::runtime_error);
  track.values.resize(0, 4);
  track.lost.clear();
  EXPECT_EQ(SmoothLds{}(model, track, context).states.frames(), 0);
}

TEST(TrainLds, TakesRunsOfMeasuredFrames) {
  Context context;
  Track track;
  track.values = sample(truth(), {40}, 1).frames;
  track.values.row(7).setConstant(1e9);
  track.lost = {7};
  std::string log;
  context.on_log = [&](std::string_view line) { log = line; };
  const Lds model = TrainLds{2}({{"a", track}}, context);
  EXPECT_NE(log.find("39 frames: log-likelihood"), std::string::npos) << log;
  EXPECT_LT(model.mean.cwiseAbs().maxCoeff(), 50);
  track.values(1, 1) = NAN;
  EXPECT_THROW(TrainLds{2}({{"a", track}}, context), std::runtime_error);
  EXPECT_THROW(TrainLds{2}({}, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
