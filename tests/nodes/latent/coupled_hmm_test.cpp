#include "nodes/latent/coupled_hmm.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Eigen::MatrixXd normalised(Eigen::MatrixXd rows) { return rows.rowwise().sum().cwiseInverse().asDiagonal() * rows; }

GaussianMixture state(const Eigen::RowVectorXd& mean, double variance) {
  return {Eigen::VectorXd::Ones(1), mean, {Eigen::VectorXd::Constant(mean.size(), variance)}};
}

/// Three states of sound in two dimensions, two of the face in one; each chain prefers what the other was.
CoupledHmm truth() {
  CoupledHmm model;
  model.audio.start = Eigen::Vector3d(0.5, 0.3, 0.2);
  model.visual.start = Eigen::Vector2d(0.4, 0.6);
  Random random(4);
  const auto transitions = [&](Eigen::Index to) {
    return normalised(Eigen::MatrixXd::NullaryExpr(6, to, [&] { return std::exp(3 * random.uniform()) - 0.9; }));
  };
  model.audio.transitions = transitions(3);
  model.visual.transitions = transitions(2);
  model.audio.observations = {state(Eigen::RowVector2d(0, 0), 0.5), state(Eigen::RowVector2d(3, 0), 0.5),
                              state(Eigen::RowVector2d(0, 3), 0.5)};
  model.visual.observations = {state(Eigen::RowVectorXd::Constant(1, -1), 0.1),
                               state(Eigen::RowVectorXd::Constant(1, 1), 0.1)};
  return model;
}

Eigen::Index draw(const Eigen::VectorXd& p, Random& random) {
  double left = random.uniform();
  Eigen::Index k = 0;
  while (k + 1 < p.size() && (left -= p(k)) > 0) ++k;
  return k;
}

struct Drawn {
  Eigen::MatrixXd audio, visual;
  std::vector<std::int64_t> lengths;
};

Drawn sample(const CoupledHmm& model, std::vector<std::int64_t> lengths, std::uint64_t seed) {
  Random random(seed);
  Eigen::Index frames = 0, row = 0;
  for (const auto length : lengths) frames += length;
  Drawn d{gaussian(frames, 2, seed + 1), gaussian(frames, 1, seed + 2), std::move(lengths)};
  for (const auto length : d.lengths)
    for (Eigen::Index t = 0, y = 0, z = 0; t < length; ++t, ++row) {
      const Eigen::Index pair = y + 3 * z;
      const auto next = [&](const CoupledChain& chain) {
        return draw(t == 0 ? chain.start : Eigen::VectorXd(chain.transitions.row(pair)), random);
      };
      y = next(model.audio);
      z = next(model.visual);
      const auto observe = [&](const CoupledChain& chain, Eigen::Index k, auto frame) {
        const GaussianMixture& m = chain.observations[static_cast<std::size_t>(k)];
        frame = frame * std::sqrt(m.covariances[0](0)) + m.means.row(0);
      };
      observe(model.audio, y, d.audio.row(row));
      observe(model.visual, z, d.visual.row(row));
    }
  return d;
}

double expect(const CoupledHmm& model, const Drawn& d, CoupledExpectations& e) {
  return expect(model.audio, model.visual, log_densities(model.audio.observations, d.audio),
                log_densities(model.visual.observations, d.visual), d.lengths, e);
}

/// One chain over the pairs of states.
MarkovChain product(const CoupledHmm& model) {
  MarkovChain chain{Eigen::VectorXd(6), Eigen::MatrixXd(6, 6)};
  for (Eigen::Index to = 0; to < 6; ++to) {
    chain.log_start(to) = std::log(model.audio.start(to % 3) * model.visual.start(to / 3));
    for (Eigen::Index from = 0; from < 6; ++from)
      chain.log_transitions(from, to) =
          std::log(model.audio.transitions(from, to % 3) * model.visual.transitions(from, to / 3));
  }
  return chain;
}

TEST(CoupledHmm, ExpectsWhatTheChainOverPairsExpects) {
  const CoupledHmm model = truth();
  for (const std::int64_t length : {1, 2, 30}) {
    const Drawn d = sample(model, {length}, 5);
    CoupledExpectations e;
    const double log_likelihood = expect(model, d, e);
    const Eigen::MatrixXd heard = log_densities(model.audio.observations, d.audio),
                          seen = log_densities(model.visual.observations, d.visual);
    Eigen::MatrixXd pairs(length, 6);
    for (Eigen::Index pair = 0; pair < 6; ++pair) pairs.col(pair) = heard.col(pair % 3) + seen.col(pair / 3);
    const ChainPosterior p = forward_backward(product(model), pairs);
    EXPECT_NEAR(log_likelihood, p.log_likelihood, 1e-9);
    for (Eigen::Index pair = 0; pair < 6; ++pair) {
      e.audio.states.col(pair % 3) -= p.states.col(pair);
      e.visual.states.col(pair / 3) -= p.states.col(pair);
      e.audio.steps.col(pair % 3) -= p.steps.col(pair);
      e.visual.steps.col(pair / 3) -= p.steps.col(pair);
    }
    for (const HmmExpectations* chain : {&e.audio, &e.visual}) {
      EXPECT_LT(chain->states.cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT(chain->steps.cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_NEAR(chain->starts.sum(), 1, 1e-10);
    }
  }
}

CoupledHmm fit(const Drawn& d, const FitCoupledHmm& options) {
  CoupledHmm model;
  Random random(2);
  Context context;
  options(d.audio, d.visual, d.lengths, model, random, context);
  return model;
}

TEST(CoupledHmm, IsNearlyAsLikelyAsTheModelItsDataWereDrawnFrom) {
  const CoupledHmm model = truth();
  FitCoupledHmm options{3, 2};
  options.tolerance = 1e-6;
  const CoupledHmm found = fit(sample(model, {500, 700, 800}, 1), options);
  const Drawn unseen = sample(model, {1000}, 99);
  CoupledExpectations e;
  const double best = expect(model, unseen, e), reached = expect(found, unseen, e);
  RecordProperty("behind the truth", fmt::format("{:.1f}", best - reached));
  EXPECT_GT(reached, best - 30);
  Context context;
  Random random(1);
  const Drawn seen = sample(model, {500, 700, 800}, 1);
  HmmExpectations alone;
  double apart = 0;
  apart += expect(TrainHmm{3}.fit({seen.audio, seen.lengths}, random, context), {unseen.audio, {1000}}, alone);
  apart += expect(TrainHmm{2}.fit({seen.visual, seen.lengths}, random, context), {unseen.visual, {1000}}, alone);
  EXPECT_GT(reached, apart + 50);
}

TEST(CoupledHmm, PosteriorNeverFalls) {
  Drawn d = sample(truth(), {1, 40, 59, 1}, 3);
  d.visual.conservativeResize(Eigen::NoChange, 2);
  d.visual.col(1).setConstant(4);
  for (const CovarianceKind kind : {CovarianceKind::full, CovarianceKind::diagonal})
    for (const int mixture : {1, 2}) {
      const CoupledHmm model = fit(d, {4, 3, mixture, kind, 1e-2, 0.1, 40, 0});
      EXPECT_GT(model.trace.size(), 3U);
      EXPECT_LT(testing::largest_fall(model.trace), 1e-12);
      EXPECT_EQ(fit(d, {4, 3, mixture, kind, 1e-2, 0.1, 40, 0}).trace, model.trace);
    }
}

TEST(CoupledHmm, InversionMakesBothStreamsEverLikelier) {
  const CoupledHmm model = truth();
  const Drawn d = sample(model, {60}, 8);
  const Inversion inverted = invert(model, d.audio, {}, 30);
  EXPECT_EQ(inverted.trace.size(), 31U);
  EXPECT_LT(testing::largest_fall(inverted.trace), 1e-12);
  EXPECT_GT(inverted.trace.back(), inverted.trace.front());

  const CoupledHmm mixed = fit(sample(model, {300}, 1), {3, 2, 3, CovarianceKind::full});
  const Inversion of_mixtures = invert(mixed, d.audio, {}, 30);
  EXPECT_LT(testing::largest_fall(of_mixtures.trace), 1e-12);
}

TEST(CoupledHmm, InversionIsStationary) {
  const CoupledHmm model = truth();
  const Drawn d = sample(model, {8}, 8);
  const Inversion inverted = invert(model, d.audio, {}, 500);
  CoupledExpectations e;
  for (Eigen::Index t = 0; t < 8; ++t) {
    const auto moved = [&](double step) {
      Drawn other{d.audio, inverted.frames, {8}};
      other.visual(t, 0) += step;
      return expect(model, other, e);
    };
    EXPECT_NEAR((moved(1e-4) - moved(-1e-4)) / 2e-4, 0, 1e-4) << t;
  }
}

TEST(CoupledHmm, AnswersFarAndDegenerateFrames) {
  const CoupledHmm model = truth();
  Drawn d = sample(model, {20}, 8);
  d.audio *= 1e4;
  CoupledExpectations e;
  EXPECT_TRUE(std::isfinite(expect(model, d, e)));
  EXPECT_TRUE(e.audio.states.rowwise().sum().isOnes(1e-9));
  EXPECT_TRUE(invert(model, d.audio, {3, 4}, 5).frames.allFinite());

  const CoupledHmm one = fit({gaussian(1, 2, 1), gaussian(1, 1, 2), {1}}, {});
  EXPECT_EQ(one.audio.states(), 1);
  EXPECT_EQ(one.visual.states(), 1);
  const CoupledHmm few = fit({gaussian(3, 2, 1), Eigen::MatrixXd::Constant(3, 1, 7), {1, 2}}, {});
  EXPECT_EQ(few.audio.states(), 3);
  EXPECT_EQ(few.visual.states(), 1);
  EXPECT_TRUE(few.audio.transitions.rowwise().sum().isOnes(1e-9));

  CoupledHmm blocked = model;
  blocked.audio.start.setZero();
  EXPECT_THROW(expect(blocked, d, e), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
