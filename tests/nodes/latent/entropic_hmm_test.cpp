#include "nodes/latent/entropic_hmm.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/latent/hmm.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

double posterior(const Eigen::VectorXd& p, const Eigen::VectorXd& counts, double prior) {
  double sum = 0;
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (counts(i) > 0 || p(i) > 0) sum += (counts(i) + prior * p(i)) * std::log(p(i));
  return sum;
}

TEST(EntropicEstimate, IsAheadOfEveryPointOfAGrid) {
  for (const Eigen::Vector3d& counts :
       {Eigen::Vector3d(20, 5, 1), Eigen::Vector3d(0.6, 0.5, 0.4), Eigen::Vector3d(0.3, 0.3, 0.3),
        Eigen::Vector3d(0.02, 0.3, 1e-6), Eigen::Vector3d(1.5, 1.5, 1.5), Eigen::Vector3d(1e-9, 2e-9, 1e-9)})
    for (const double prior : {0.1, 1.0, 3.0}) {
      const Eigen::VectorXd p = entropic_estimate(counts, prior);
      EXPECT_NEAR(p.sum(), 1, 1e-12);
      const double reached = posterior(p, counts, prior);
      for (int i = 1; i < 200; ++i)
        for (int j = 1; i + j < 200; ++j) {
          const Eigen::Vector3d other(i / 200.0, j / 200.0, (200 - i - j) / 200.0);
          EXPECT_LE(posterior(other, counts, prior), reached + 1e-9) << counts.transpose() << ", " << prior;
        }
    }
}

TEST(EntropicEstimate, IsStationaryByLambertsFunction) {
  const Eigen::Vector4d counts(800, 150, 3, 0.2);
  const Eigen::VectorXd p = entropic_estimate(counts, 2);
  const Eigen::ArrayXd slopes = counts.array() / p.array() + 2 * p.array().log();
  EXPECT_LT(slopes.maxCoeff() - slopes.minCoeff(), 1e-6 * slopes.abs().maxCoeff());
  EXPECT_LT(p(3), counts(3) / counts.sum());
  EXPECT_GT(p(0), counts(0) / counts.sum());
}

TEST(EntropicEstimate, GivesSharesWithoutPriorAndNothingToWhatHasNone) {
  EXPECT_TRUE(entropic_estimate(Eigen::Vector3d(2, 0, 6), 0).isApprox(Eigen::Vector3d(0.25, 0, 0.75)));
  EXPECT_EQ(entropic_estimate(Eigen::Vector3d(0, 0, 6), 1), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(entropic_estimate(Eigen::Vector3d(0, 0, 1e-200), 1), Eigen::Vector3d(0, 0, 1));
  const Eigen::VectorXd many = entropic_estimate(Eigen::Vector3d(4e6, 0, 1e6), 1);
  EXPECT_NEAR(many(0), 0.8, 1e-5);
  EXPECT_EQ(many(1), 0);
}

TEST(Trim, TakesOutWhatIsHardlyUsed) {
  Eigen::VectorXd p = Eigen::Vector4d(0.7, 0.25, 0.04, 0.01);
  EXPECT_TRUE(trim(p, Eigen::Vector4d(70, 25, 0.3, 0.001), 1));
  EXPECT_TRUE(p.isApprox(Eigen::Vector4d(0.7 / 0.95, 0.25 / 0.95, 0, 0)));
  EXPECT_FALSE(trim(p, Eigen::Vector4d(70, 25, 0, 0), 1));
  Eigen::VectorXd one = Eigen::Vector2d(1, 0);
  EXPECT_FALSE(trim(one, Eigen::Vector2d(0.1, 0), 1));
}

/// States on a ring: each stays or goes to the next.
Sequences ring(int states, int frames, double noise) {
  Random random(3);
  Sequences data{noise * gaussian(frames, 2, 8), {frames / 2, frames - frames / 2}};
  int state = 0;
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double angle = 2 * 3.141592653589793 * state / states;
    data.frames.row(t) += 3 * Eigen::RowVector2d(std::cos(angle), std::sin(angle));
    if (random.uniform() < 0.3) state = (state + 1) % states;
  }
  return data;
}

Hmm fit(const EntropicHmm& train, const Sequences& data) {
  Random random(1);
  Context context;
  return train.fit(data, random, context);
}

TEST(EntropicHmm, FindsTheTransitionsThereAre) {
  const Sequences data = ring(6, 2000, 0.7);
  const Hmm sparse = fit({6}, data), plain = fit({6, 0}, data);
  EXPECT_EQ((sparse.transitions.array() > 0).count(), 12);
  for (Eigen::Index k = 0; k < 6; ++k) {
    EXPECT_EQ((sparse.transitions.row(k).array() > 0).count(), 2);
    EXPECT_NEAR(sparse.transitions(k, k), 0.7, 0.06);
  }
  EXPECT_EQ((plain.transitions.array() > 0).count(), 36);
  HmmExpectations e;
  EXPECT_NEAR(expect(sparse, data, e) / 2000, expect(plain, data, e) / 2000, 0.01);
}

TEST(EntropicHmm, PosteriorNeverFalls) {
  for (const CovarianceKind kind : {CovarianceKind::full, CovarianceKind::diagonal})
    for (const double prior : {0.0, 1.0, 20.0}) {
      Sequences data = ring(5, 120, 1.5);
      data.frames.conservativeResize(Eigen::NoChange, 3);
      data.frames.col(2).setConstant(-2);
      data.lengths = {1, 60, 59};
      const Hmm model = fit({6, prior, kind, 1e-2, 200, 0}, data);
      EXPECT_GT(model.trace.size(), 5U);
      EXPECT_LT(testing::largest_fall(model.trace), 1e-12);
    }
}

TEST(EntropicHmm, WithoutPriorIsBaumWelch) {
  const Sequences data = ring(4, 400, 1);
  Random random(1);
  Context context;
  const Hmm plain = TrainHmm{4, 1, CovarianceKind::full, 1e-2, 100, 1e-5}.fit(data, random, context);
  const Hmm entropic = fit({4, 0, CovarianceKind::full, 1e-2, 100, 1e-5}, data);
  EXPECT_EQ(entropic.trace.size(), plain.trace.size());
  EXPECT_NEAR(entropic.trace.back(), plain.trace.back(), 1e-9 * std::abs(plain.trace.back()));
  EXPECT_EQ(fit({4}, data).trace, fit({4}, data).trace);
}

TEST(EntropicHmm, AnswersDegenerateData) {
  const auto states = [](const Eigen::MatrixXd& frames, std::vector<std::int64_t> lengths) {
    const Hmm model = fit({4}, {frames, std::move(lengths)});
    EXPECT_TRUE(model.transitions.rowwise().sum().isOnes(1e-9));
    EXPECT_NEAR(model.start.sum(), 1, 1e-9);
    EXPECT_TRUE(log_densities(model, frames).allFinite());
    return model.states();
  };
  EXPECT_EQ(states(gaussian(1, 3, 1), {1}), 1);
  EXPECT_EQ(states(gaussian(6, 9, 1), {1, 1, 1, 1, 1, 1}), 4);
  EXPECT_EQ(states(Eigen::MatrixXd::Constant(5, 2, 3), {5}), 1);
  EXPECT_EQ(states(gaussian(2, 2, 1).replicate(4, 1), {4, 4}), 2);
}

}  // namespace
}  // namespace talkgraph
