#include "nodes/latent/gmm.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::positive;

GaussianMixture three_components() {
  GaussianMixture mixture{Eigen::Vector3d(0.5, 0.3, 0.2), Eigen::MatrixXd(3, 2), {}};
  mixture.means << 0, 0, 6, 1, -2, 7;
  for (std::uint64_t k = 0; k < 3; ++k) mixture.covariances.push_back(positive(2, 10 + k, 0.3));
  return mixture;
}

Eigen::MatrixXd sample(const GaussianMixture& mixture, Eigen::Index frames, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd rows = gaussian(frames, mixture.dimension(), seed + 1);
  for (Eigen::Index n = 0; n < frames; ++n) {
    double left = random.uniform();
    Eigen::Index k = 0;
    while (k + 1 < mixture.components() && (left -= mixture.weights(k)) > 0) ++k;
    const Eigen::MatrixXd root = mixture.covariances[static_cast<std::size_t>(k)].llt().matrixL();
    rows.row(n) = mixture.means.row(k) + rows.row(n) * root.transpose();
  }
  return rows;
}

TEST(Gmm, RecoversTheMixtureItsDataWereDrawnFrom) {
  const GaussianMixture truth = three_components();
  const Eigen::MatrixXd frames = sample(truth, 20000, 1);
  Random random(3);
  Context context;
  const GaussianMixture found = TrainGmm{.components = 3}.fit(frames, random, context).mixture;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Eigen::Index at = 0;
    (found.means.rowwise() - truth.means.row(k)).rowwise().norm().minCoeff(&at);
    EXPECT_NEAR(found.weights(at), truth.weights(k), 0.02);
    EXPECT_LT((found.means.row(at) - truth.means.row(k)).norm(), 0.1);
    EXPECT_TRUE(
        found.covariances[static_cast<std::size_t>(at)].isApprox(truth.covariances[static_cast<std::size_t>(k)], 0.1));
  }
}

TEST(Gmm, DensitiesAndResponsibilitiesAreThoseOfTextbooks) {
  GaussianMixture mixture = three_components();
  const Eigen::MatrixXd frames = sample(mixture, 10, 1);
  const auto check = [&](const GaussianMixture& m) {
    const Eigen::VectorXd logs = log_likelihood(m, frames);
    const Eigen::MatrixXd given = responsibilities(m, frames);
    for (Eigen::Index n = 0; n < frames.rows(); ++n) {
      Eigen::Vector3d joint;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Eigen::MatrixXd& c = m.covariances[static_cast<std::size_t>(k)];
        const Eigen::MatrixXd dense = c.cols() == 1 ? Eigen::MatrixXd(c.col(0).asDiagonal()) : c;
        joint(k) = m.weights(k) * std::exp(testing::log_normal_density(frames.row(n), m.means.row(k), dense));
      }
      EXPECT_NEAR(logs(n), std::log(joint.sum()), 1e-9);
      EXPECT_TRUE(given.row(n).isApprox(joint.transpose() / joint.sum(), 1e-9));
    }
  };
  check(mixture);
  for (Eigen::MatrixXd& c : mixture.covariances) c = c.diagonal().eval();
  check(mixture);
}

TEST(Gmm, LikelihoodNeverFalls) {
  Context context;
  for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal})
    for (const double floor : {1e-6, 1e-3, 0.3})
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        Eigen::MatrixXd frames = sample(three_components(), 60, seed) * gaussian(2, 5, seed) + 0.1 * gaussian(60, 5, 9);
        frames.col(1) *= 1e4;
        frames.col(2).setConstant(1e3);
        Random random(seed);
        const Gmm model =
            TrainGmm{.components = 6, .covariance = kind, .floor = floor, .iterations = 60, .tolerance = 0}.fit(
                frames, random, context);
        EXPECT_GT(model.trace.size(), 3U);
        EXPECT_LT(testing::largest_fall(model.trace), 1e-12);
        EXPECT_NEAR(model.trace.back(), log_likelihood(model.mixture, frames).sum(),
                    1e-9 * std::abs(model.trace.back()));
      }
}

TEST(Gmm, SameSeedSameModel) {
  const Eigen::MatrixXd frames = gaussian(100, 3, 1);
  Context context;
  Random a(5), b(5), c(6);
  const Gmm first = TrainGmm{}.fit(frames, a, context), same = TrainGmm{}.fit(frames, b, context);
  EXPECT_EQ(first.mixture.means, same.mixture.means);
  EXPECT_EQ(first.trace, same.trace);
  EXPECT_NE(first.trace, TrainGmm{}.fit(frames, c, context).trace);
}

TEST(Gmm, AnswersDegenerateData) {
  Context context;
  for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal}) {
    const auto fit = [&](const Eigen::MatrixXd& frames) {
      Random random(1);
      Gmm model = TrainGmm{.components = 4, .covariance = kind}.fit(frames, random, context);
      EXPECT_TRUE(responsibilities(model.mixture, frames).allFinite());
      EXPECT_NEAR(model.mixture.weights.sum(), 1, 1e-12);
      return model;
    };
    EXPECT_EQ(fit(gaussian(1, 3, 1)).mixture.components(), 1);
    EXPECT_EQ(fit(Eigen::MatrixXd::Constant(9, 2, 0.1)).mixture.components(), 1);
    EXPECT_EQ(fit(gaussian(3, 8, 1)).mixture.components(), 3);
    EXPECT_EQ(fit(gaussian(2, 2, 1).replicate(5, 1)).mixture.components(), 2);
    EXPECT_EQ(fit(gaussian(50, 1, 1) * 1e-150).mixture.components(), 4);
    EXPECT_EQ(fit(gaussian(50, 1, 1) * 1e100).mixture.components(), 4);
  }
}

TEST(Gmm, HasNoMoreComponentsThanFrames) {
  Random random(1);
  Context context;
  EXPECT_EQ(TrainGmm{.components = 2'000'000'000}.fit(gaussian(5, 2, 1), random, context).mixture.components(), 5);
}

TEST(Gmm, AStarvedComponentStays) {
  GaussianMixture mixture = three_components();
  const Eigen::MatrixXd frames = gaussian(20, 2, 1);
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(20, 3);
  given.col(0).setOnes();
  maximise(mixture, frames, given, variance_floors(frames, 1e-3), CovarianceKind::full);
  EXPECT_EQ(mixture.means.row(1), three_components().means.row(1));
  EXPECT_TRUE(mixture.means.row(0).isApprox(frames.colwise().mean()));
  EXPECT_TRUE(log_likelihood(mixture, frames).allFinite());
  EXPECT_TRUE(responsibilities(mixture, frames).isApprox(given));
}

TEST(Floored, IsTheLikeliestCovarianceAboveTheFloor) {
  const Eigen::Vector3d floors(0.5, 0.01, 2);
  const Eigen::MatrixXd sample = positive(3, 1, 0), best = floored(sample, floors);
  const Eigen::MatrixXd excess = best - Eigen::MatrixXd(floors.asDiagonal());
  EXPECT_GT(excess.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
  const auto likelihood = [&](const Eigen::MatrixXd& c) {
    return -std::log(c.determinant()) - (c.inverse() * sample).trace();
  };
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Eigen::MatrixXd root = gaussian(3, 3, seed);
    const Eigen::MatrixXd other = Eigen::MatrixXd(floors.asDiagonal()) + root * root.transpose();
    EXPECT_LE(likelihood(0.99 * best + 0.01 * other), likelihood(best));
  }
  EXPECT_EQ(floored(positive(3, 1, 10), floors), positive(3, 1, 10));
}

Track track_of(Eigen::MatrixXd values) {
  Track track;
  track.values = std::move(values);
  return track;
}

TEST(TrainGmm, LearnsFromMeasuredFramesAndSaysWhereItCannot) {
  Context context;
  Random random(1);
  Track track = track_of(gaussian(40, 2, 1));
  track.lost = {5};
  track.values.row(5).setConstant(1e6);
  std::string log;
  context.on_log = [&](std::string_view line) { log = line; };
  TrainGmm train;
  train.components = 2;
  const Gmm model = train({{"a", track}}, random, context);
  EXPECT_LT(model.mixture.means.cwiseAbs().maxCoeff(), 10);
  EXPECT_NE(log.find("39 frames: log-likelihood"), std::string::npos) << log;
  track.values.row(5).setConstant(1e200);
  const Track given = GmmResponsibilities{}(model, track);
  EXPECT_TRUE(given.values.rowwise().sum().isOnes(1e-12));
  EXPECT_EQ(given.values.row(5), model.mixture.weights.transpose()) << "not observed";
  EXPECT_EQ(given.values.row(6), responsibilities(model.mixture, track.values.row(6)).row(0));
  EXPECT_EQ(given.lost, track.lost);
  EXPECT_EQ(GmmResponsibilities{}(model, track_of(Eigen::MatrixXd(0, 2))).frames(), 0);
  EXPECT_THROW(GmmResponsibilities{}(model, track_of(gaussian(3, 3, 1))), std::runtime_error);
  track.values(7, 1) = NAN;
  EXPECT_THROW(GmmResponsibilities{}(model, track), std::runtime_error);
  EXPECT_THROW(train({{"a", track}}, random, context), std::runtime_error);
  EXPECT_THROW(train({}, random, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
