#include "nodes/latent/hmm.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "nodes/latent/gmm.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::positive;

/// Three states in two dimensions; the first has two components.
Hmm truth() {
  Hmm model{Eigen::Vector3d(0.7, 0.2, 0.1), Eigen::MatrixXd(3, 3), {}, {}};
  model.transitions << 0.8, 0.15, 0.05, 0.1, 0.8, 0.1, 0.3, 0.1, 0.6;
  const auto component = [](double x, double y) { return Eigen::RowVector2d(x, y); };
  model.observations.push_back({Eigen::Vector2d(0.6, 0.4), Eigen::MatrixXd(2, 2), {positive(2, 1), positive(2, 2)}});
  model.observations[0].means << component(0, 0), component(0, 3);
  model.observations.push_back({Eigen::VectorXd::Ones(1), component(7, 0), {positive(2, 3)}});
  model.observations.push_back({Eigen::VectorXd::Ones(1), component(7, 8), {positive(2, 4)}});
  return model;
}

Eigen::Index draw(const Eigen::VectorXd& p, Random& random) {
  double left = random.uniform();
  Eigen::Index k = 0;
  while (k + 1 < p.size() && (left -= p(k)) > 0) ++k;
  return k;
}

Sequences sample(const Hmm& model, const std::vector<std::int64_t>& lengths, std::uint64_t seed) {
  Random random(seed);
  Eigen::Index frames = 0;
  for (const auto length : lengths) frames += length;
  Sequences s{gaussian(frames, 2, seed + 100), lengths};
  Eigen::Index row = 0;
  for (const auto length : lengths)
    for (Eigen::Index t = 0, state = 0; t < length; ++t, ++row) {
      state = draw(t == 0 ? model.start : Eigen::VectorXd(model.transitions.row(state).transpose()), random);
      const GaussianMixture& m = model.observations[static_cast<std::size_t>(state)];
      const Eigen::Index c = draw(m.weights, random);
      const Eigen::MatrixXd root = m.covariances[static_cast<std::size_t>(c)].llt().matrixL();
      s.frames.row(row) = m.means.row(c) + s.frames.row(row) * root.transpose();
    }
  return s;
}

/// Sums and maxima over all paths.
struct Enumerated {
  double probability = 0, best = 0;
  std::vector<Eigen::Index> path;
  Eigen::MatrixXd states, steps;
};

Enumerated enumerate(const Hmm& model, const Eigen::MatrixXd& frames) {
  const Eigen::Index states = model.states(), length = frames.rows();
  Eigen::MatrixXd densities = Eigen::MatrixXd::Zero(length, states);
  for (Eigen::Index t = 0; t < length; ++t)
    for (Eigen::Index k = 0; k < states; ++k) {
      const GaussianMixture& m = model.observations[static_cast<std::size_t>(k)];
      for (Eigen::Index c = 0; c < m.components(); ++c)
        densities(t, k) +=
            m.weights(c) * std::exp(testing::log_normal_density(frames.row(t), m.means.row(c),
                                                                m.covariances[static_cast<std::size_t>(c)]));
    }
  Enumerated e;
  e.states.setZero(length, states);
  e.steps.setZero(states, states);
  const auto paths = std::lround(std::pow(states, length));
  for (Eigen::Index number = 0; number < paths; ++number) {
    std::vector<Eigen::Index> path;
    for (Eigen::Index t = 0, rest = number; t < length; ++t, rest /= states) path.push_back(rest % states);
    double p = model.start(path[0]) * densities(0, path[0]);
    for (std::size_t t = 1; t < path.size(); ++t)
      p *= model.transitions(path[t - 1], path[t]) * densities(static_cast<Eigen::Index>(t), path[t]);
    e.probability += p;
    if (p > e.best) e.best = p, e.path = path;
    for (std::size_t t = 0; t < path.size(); ++t) {
      e.states(static_cast<Eigen::Index>(t), path[t]) += p;
      if (t > 0) e.steps(path[t - 1], path[t]) += p;
    }
  }
  e.states /= e.probability;
  e.steps /= e.probability;
  return e;
}

TEST(Hmm, PosteriorsLikelihoodAndPathAreThoseOverAllPaths) {
  const Hmm model = truth();
  const MarkovChain chain = chain_of(model);
  for (const std::int64_t length : {1, 2, 7})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const Eigen::MatrixXd frames = 0.5 * sample(model, {length}, seed).frames;
      const Eigen::MatrixXd logs = log_densities(model, frames);
      const Enumerated all = enumerate(model, frames);
      const ChainPosterior p = forward_backward(chain, logs);
      EXPECT_NEAR(p.log_likelihood, std::log(all.probability), 1e-9);
      EXPECT_LT((p.states - all.states).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((p.steps - all.steps).cwiseAbs().maxCoeff(), 1e-10);
      const ChainPath path = viterbi(chain, logs);
      EXPECT_EQ(path.states, all.path);
      EXPECT_NEAR(path.log_probability, std::log(all.best), 1e-9);
    }
}

TEST(Hmm, RecoversTheModelItsDataWereDrawnFrom) {
  const Hmm model = truth();
  const Sequences data = sample(model, std::vector<std::int64_t>(60, 200), 1);
  Context context;
  Random random(2);
  TrainHmm train;
  train.states = 3;
  train.mixture = 2;
  train.covariance = CovarianceKind::full;
  const Hmm found = train.fit(data, random, context);
  double reached = 0;
  for (Eigen::Index s = 0; s < 60; ++s)
    reached +=
        forward_backward(chain_of(model), log_densities(model, data.frames.middleRows(200 * s, 200))).log_likelihood;
  EXPECT_GT(found.trace.back(), reached);
  EXPECT_LT(found.trace.back(), reached + 100);
  std::vector<Eigen::Index> at(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::RowVectorXd mean = model.observations[k].weights.transpose() * model.observations[k].means;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < 3; ++j) {
      const GaussianMixture& m = found.observations[j];
      const double distance = (m.weights.transpose() * m.means - mean).norm();
      if (distance < least) least = distance, at[k] = static_cast<Eigen::Index>(j);
    }
    EXPECT_LT(least, 0.2);
  }
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(found.start(at[j]), model.start(static_cast<Eigen::Index>(j)), 0.15);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(found.transitions(at[j], at[k]),
                  model.transitions(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)), 0.03);
  }
}

TEST(Hmm, LikelihoodNeverFalls) {
  Context context;
  for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal})
    for (const int mixture : {1, 3})
      for (const double floor : {1e-4, 0.1})
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
          Sequences data = sample(truth(), {1, 20, 1, 35, 3}, seed);
          data.frames = (data.frames * gaussian(2, 4, seed) + 0.1 * gaussian(60, 4, 7)).eval();
          data.frames.col(3).setConstant(-2);
          Random random(seed);
          TrainHmm train{5, mixture, kind, floor, 60, 0};
          const Hmm model = train.fit(data, random, context);
          EXPECT_GT(model.trace.size(), 3U);
          EXPECT_LT(testing::largest_fall(model.trace), 1e-12);
        }
}

TEST(Hmm, OneStateIsAMixtureAndSameSeedSameModel) {
  const Sequences data = sample(truth(), {50, 30}, 1);
  Context context;
  Random a(5), b(5), c(5);
  TrainHmm one{1, 1, CovarianceKind::full, 1e-3, 20, 0};
  TrainGmm gaussian_alone;
  gaussian_alone.components = 1;
  EXPECT_NEAR(one.fit(data, a, context).trace.back(), gaussian_alone.fit(data.frames, b, context).trace.back(), 1e-8);
  Random d(9), e(9);
  EXPECT_EQ(TrainHmm{}.fit(data, d, context).trace, TrainHmm{}.fit(data, e, context).trace);
}

TEST(Hmm, LongSequencesAndFarFramesNeitherUnderflowNorLoseAPath) {
  Hmm model = truth();
  // Left to right: the third state can only be reached through the second.
  model.start << 1, 0, 0;
  model.transitions << 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 1;
  const MarkovChain chain = chain_of(model);
  Eigen::MatrixXd logs = Eigen::MatrixXd::Constant(4, 3, -1e5);
  logs.col(0).setZero();
  logs.row(3) << -1e6, -1e6, 0;
  const ChainPosterior p = forward_backward(chain, logs);
  EXPECT_TRUE(p.states.row(2).isApprox(Eigen::RowVector3d(0, 1, 0)));
  EXPECT_EQ(viterbi(chain, logs).states, (std::vector<Eigen::Index>{0, 0, 1, 2}));
  EXPECT_NEAR(p.log_likelihood, -1e5 + 3 * std::log(0.5), 1e-6);

  const Sequences far = sample(truth(), {20000}, 1);
  const ChainPosterior longest = forward_backward(chain_of(truth()), log_densities(truth(), 30 * far.frames));
  EXPECT_TRUE(longest.states.rowwise().sum().isOnes(1e-9));
  EXPECT_NEAR(longest.steps.sum(), 19999, 1e-4);

  logs.row(0) << -std::numeric_limits<double>::infinity(), 0, 0;
  EXPECT_THROW(forward_backward(chain, logs), std::runtime_error);
  EXPECT_THROW(viterbi(chain, logs), std::runtime_error);
}

TEST(Hmm, AnswersDegenerateData) {
  Context context;
  const auto fit = [&](const Eigen::MatrixXd& frames, std::vector<std::int64_t> lengths) {
    Random random(1);
    Hmm model = TrainHmm{4, 2}.fit({frames, std::move(lengths)}, random, context);
    EXPECT_TRUE(model.transitions.rowwise().sum().isOnes(1e-9));
    EXPECT_NEAR(model.start.sum(), 1, 1e-9);
    EXPECT_TRUE(log_densities(model, frames).allFinite());
    return model.states();
  };
  EXPECT_EQ(fit(gaussian(1, 3, 1), {1}), 1);
  EXPECT_EQ(fit(gaussian(6, 9, 1), {1, 1, 1, 1, 1, 1}), 4);
  EXPECT_EQ(fit(Eigen::MatrixXd::Constant(5, 2, 3), {5}), 1);
  EXPECT_EQ(fit(gaussian(2, 2, 1).replicate(4, 1), {4, 4}), 2);
}

TEST(DecodeHmm, SaysStatesOfATrackAndBridgesLostFrames) {
  const Hmm model = truth();
  const Sequences drawn = sample(model, {40}, 1);
  Track track;
  track.values = drawn.frames;
  Context context;
  const auto plain = DecodeHmm{}(model, track, context);
  EXPECT_EQ(plain.labels.labels.size(), 40U);
  EXPECT_TRUE(plain.posteriors.values.rowwise().sum().isOnes(1e-9));
  track.lost = {10};
  track.values.row(10).setConstant(1e5);
  const auto bridged = DecodeHmm{}(model, track, context);
  EXPECT_EQ(bridged.labels.labels[10], bridged.labels.labels[9]);
  EXPECT_EQ(bridged.posteriors.lost, track.lost);
  EXPECT_NE(plain.posteriors.values.row(10), bridged.posteriors.values.row(10));

  track.values(3, 0) = NAN;
  EXPECT_THROW(DecodeHmm{}(model, track, context), std::runtime_error);
  track.values.resize(3, 5);
  EXPECT_THROW(DecodeHmm{}(model, track, context), std::runtime_error);
  track.values.resize(0, 2);
  track.lost.clear();
  EXPECT_TRUE(DecodeHmm{}(model, track, context).labels.labels.empty());
}

TEST(TrainHmm, TakesRunsOfMeasuredFrames) {
  Context context;
  Random random(1);
  Track track;
  track.values = gaussian(30, 2, 1);
  track.lost = {4, 5};
  track.values.row(4).setConstant(1e9);
  std::string log;
  context.on_log = [&](std::string_view line) { log = line; };
  const Hmm model = TrainHmm{2}({{"a", track}}, random, context);
  EXPECT_NE(log.find("28 frames: log-likelihood"), std::string::npos) << log;
  EXPECT_LT(model.observations[0].means.cwiseAbs().maxCoeff(), 10);
  track.values(1, 1) = NAN;
  EXPECT_THROW(TrainHmm{2}({{"a", track}}, random, context), std::runtime_error);
  EXPECT_THROW(TrainHmm{2}({}, random, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
