#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "nodes/latent/linear_models.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

/// Largest sine of the angles between two column spaces.
double distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const auto basis = [](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
    return m.householderQr().householderQ() * Eigen::MatrixXd::Identity(m.rows(), m.cols());
  };
  const Eigen::MatrixXd p = basis(a), q = basis(b);
  return (q - p * (p.transpose() * q)).norm();
}

TEST(Pcca, RecoversTheSubspaceItsDataWereDrawnFrom) {
  const Eigen::Index n = 20000;
  const auto x = gaussian(n, 2, 1), wy = gaussian(2, 6, 2), wz = gaussian(2, 5, 3);
  const Eigen::MatrixXd y = x * wy + 0.3 * gaussian(n, 6, 4), z = x * wz + 0.3 * gaussian(n, 5, 5);
  const Pcca model = fit_pcca(y, z, 2);
  EXPECT_LT(distance(model.loadings_y, wy.transpose()), 0.03);
  EXPECT_LT(distance(model.loadings_z, wz.transpose()), 0.03);
  const Eigen::MatrixXd latent = model.posterior_mean(y, z);
  const Eigen::MatrixXd fitted = latent * (latent.transpose() * latent).ldlt().solve(latent.transpose() * x);
  EXPECT_LT((fitted - x).squaredNorm() / x.squaredNorm(), 0.05);
}

TEST(Pcca, PosteriorMeanIsThatOfTheJointGaussian) {
  const Eigen::Index n = 200;
  const auto x = gaussian(n, 2, 1);
  const Eigen::MatrixXd y = x * gaussian(2, 4, 2) + gaussian(n, 4, 4), z = x * gaussian(2, 3, 3) + gaussian(n, 3, 5);
  const Pcca model = fit_pcca(y, z, 2, 0);
  const Eigen::MatrixXd a = y.rowwise() - model.mean_y, b = z.rowwise() - model.mean_z;
  Eigen::MatrixXd joint(7, 7), loadings(7, 2), both(n, 7);
  loadings << model.loadings_y, model.loadings_z;
  both << a, b;
  joint << a.transpose() * a / n, model.loadings_y * model.loadings_z.transpose(),
      model.loadings_z * model.loadings_y.transpose(), b.transpose() * b / n;
  EXPECT_TRUE(model.posterior_mean(y, z).isApprox(both * joint.inverse() * loadings, 1e-6));
}

TEST(Pcca, PosteriorsAndDensityAreThoseOfTheJointGaussian) {
  const Eigen::Index n = 300;
  const auto x = gaussian(n, 2, 1);
  const Eigen::MatrixXd y = x * gaussian(2, 4, 2) + gaussian(n, 4, 4), z = x * gaussian(2, 3, 3) + gaussian(n, 3, 5);
  const Pcca model = fit_pcca(y, z, 2, 0);
  Eigen::MatrixXd joint(7, 7), loadings(7, 2);
  loadings << model.loadings_y, model.loadings_z;
  joint << model.covariance_y, model.loadings_y * model.loadings_z.transpose(),
      model.loadings_z * model.loadings_y.transpose(), model.covariance_z;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd both = identity - loadings.transpose() * joint.inverse() * loadings;
  EXPECT_TRUE(both.isApprox(Eigen::MatrixXd(model.posterior_variance().asDiagonal()), 1e-9));
  const auto gain = [](const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& w) -> Eigen::MatrixXd {
    return covariance.inverse() * w;
  };
  const Eigen::MatrixXd gain_y = gain(model.covariance_y, model.loadings_y);
  EXPECT_TRUE(model.posterior_mean_of_y(y).isApprox((y.rowwise() - model.mean_y) * gain_y, 1e-9));
  EXPECT_TRUE(model.posterior_mean_of_z(z).isApprox(
      (z.rowwise() - model.mean_z) * gain(model.covariance_z, model.loadings_z), 1e-9));
  EXPECT_TRUE((identity - model.loadings_y.transpose() * gain_y)
                  .isApprox(Eigen::MatrixXd(model.posterior_variance_of_one().asDiagonal()), 1e-9));

  const Eigen::VectorXd log_likelihood = model.log_likelihood(y, z);
  Eigen::VectorXd row(7), mean(7);
  mean << model.mean_y.transpose(), model.mean_z.transpose();
  for (Eigen::Index i = 0; i < n; i += 50) {
    row << y.row(i).transpose(), z.row(i).transpose();
    EXPECT_NEAR(log_likelihood(i), testing::log_normal_density(row, mean, joint), 1e-9);
  }
  Pcca broken = model;
  broken.covariance_y.setZero();
  EXPECT_THROW(broken.log_likelihood(y, z), std::runtime_error);
}

TEST(Pcca, IsLikelierThanOtherModelsOfItsForm) {
  const Eigen::Index n = 400;
  const auto x = gaussian(n, 1, 1);
  const Eigen::MatrixXd y = x * gaussian(1, 3, 2) + gaussian(n, 3, 4), z = x * gaussian(1, 2, 3) + gaussian(n, 2, 5);
  const Pcca best = fit_pcca(y, z, 1, 0);
  const double reached = best.log_likelihood(y, z).sum();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Pcca other = best;
    other.loadings_y += 0.02 * gaussian(3, 1, 100 + seed);
    other.loadings_z += 0.02 * gaussian(2, 1, 200 + seed);
    other.covariance_y *= 1 + 0.01 * gaussian(1, 1, 300 + seed)(0);
    EXPECT_LT(other.log_likelihood(y, z).sum(), reached);
  }
}

TEST(Cca, DirectionsAreNormedUncorrelatedAndOfGreatestCorrelation) {
  const Eigen::Index n = 500;
  const auto x = gaussian(n, 2, 1);
  const Eigen::MatrixXd y = x * gaussian(2, 5, 2) + gaussian(n, 5, 4), z = x * gaussian(2, 3, 3) + gaussian(n, 3, 5);
  const Cca model = fit_cca(y, z, 3);
  const Eigen::MatrixXd a = y.rowwise() - model.mean_y, b = z.rowwise() - model.mean_z;
  const Eigen::MatrixXd u = a * model.directions_y, v = b * model.directions_z;
  EXPECT_TRUE((u.transpose() * u).isIdentity(1e-10));
  EXPECT_TRUE((v.transpose() * v).isIdentity(1e-10));
  EXPECT_TRUE((u.transpose() * v).isApprox(Eigen::MatrixXd(model.correlations.asDiagonal()), 1e-10));
  const Eigen::MatrixXd map =
      (a.transpose() * a).inverse() * (a.transpose() * b) * (b.transpose() * b).inverse() * (b.transpose() * a);
  const Eigen::VectorXd squares = map.eigenvalues().real();
  EXPECT_NEAR(model.correlations(0), std::sqrt(squares.maxCoeff()), 1e-10);
  EXPECT_TRUE(fit_pcca(y, z, 3, 0).correlations.isApprox(model.correlations, 1e-6));
}

TEST(Cca, AnswersDegenerateData) {
  Eigen::MatrixXd y = gaussian(4, 8, 1), z = gaussian(4, 6, 2);
  y.col(3).setConstant(7);
  const Cca few = fit_cca(y, z, 5);
  EXPECT_TRUE(few.correlations.head(3).isOnes(1e-9));
  EXPECT_TRUE(few.correlations.tail(2).isZero());
  EXPECT_TRUE(few.directions_y.allFinite());
  EXPECT_NEAR(((y.rowwise() - few.mean_y) * few.directions_y.col(0)).norm(), 1, 1e-9);
  EXPECT_TRUE(fit_cca(y.topRows(1), z.topRows(1), 2).directions_y.isZero());
  EXPECT_TRUE(fit_cca(Eigen::MatrixXd::Constant(5, 2, 3.3), gaussian(5, 2, 1), 2).correlations.isZero());
  y(2, 2) = NAN;
  EXPECT_THROW(fit_cca(y, z, 1), std::runtime_error);
  EXPECT_THROW(fit_pcca(z, y, 1), std::runtime_error);
  EXPECT_THROW(fit_cca(y.topRows(3), z, 1), std::runtime_error);
}

TEST(Pcca, RefusesADensityOfStreamsThatDetermineEachOther) {
  const auto y = gaussian(50, 4, 1);
  for (const double shrinkage : {0, 1})
    EXPECT_THROW(fit_pcca(y, y, 2, shrinkage).log_likelihood(y, y), std::runtime_error);
}

Track track_of(Eigen::MatrixXd values, std::vector<std::int64_t> lost = {}) {
  Track track;
  track.values = std::move(values);
  track.lost = std::move(lost);
  return track;
}

/// Two streams of one latent path.
struct Streams {
  Collected<Track> audio, visual;
  Eigen::MatrixXd y, z;  ///< what is measured of both
  Streams() {
    const auto x = gaussian(60, 2, 1);
    const Eigen::MatrixXd a = x * gaussian(2, 4, 2) + 0.3 * gaussian(60, 4, 4);
    const Eigen::MatrixXd v = x * gaussian(2, 3, 3) + 0.3 * gaussian(60, 3, 5);
    audio = {{"a", track_of(a.topRows(30), {2})}, {"b", track_of(a.bottomRows(30))}, {"c", track_of(a)}};
    visual = {{"a", track_of(v.topRows(28), {5})}, {"b", track_of(v.bottomRows(30))}};
    std::vector<Eigen::Index> rows;
    for (Eigen::Index t = 0; t < 60; ++t)
      if (t != 2 && t != 5 && t != 28 && t != 29) rows.push_back(t);
    y = a(rows, Eigen::all);
    z = v(rows, Eigen::all);
  }
};

TEST(TrainCca, LearnsFromFramesThatBothStreamsHaveAndProjectsEach) {
  Context context;
  const Streams s;
  const Cca model = TrainCca{}(s.audio, s.visual, context), expected = fit_cca(s.y, s.z, 2);
  EXPECT_EQ(model.directions_y, expected.directions_y);
  EXPECT_EQ(model.correlations, expected.correlations);
  const Track heard = ProjectCca{CanonicalStream::audio}(model, track_of(s.y, {3}));
  const Track seen = ProjectCca{CanonicalStream::visual}(model, track_of(s.z));
  EXPECT_EQ(heard.lost, (std::vector<std::int64_t>{3}));
  EXPECT_TRUE(
      (heard.values.transpose() * seen.values).isApprox(Eigen::MatrixXd(model.correlations.asDiagonal()), 1e-9));
  EXPECT_THROW(ProjectCca{CanonicalStream::visual}(model, track_of(s.y)), std::runtime_error);
  EXPECT_EQ(ProjectCca{}(model, track_of(Eigen::MatrixXd(0, 4))).frames(), 0);
}

TEST(TrainPcca, LearnsFromFramesThatBothStreamsHave) {
  Context context;
  const Streams s;
  const Pcca model = TrainPcca{}(s.audio, s.visual, context), expected = fit_pcca(s.y, s.z, 2);
  EXPECT_EQ(model.loadings_y, expected.loadings_y);
  EXPECT_EQ(model.covariance_z, expected.covariance_z);
  EXPECT_THROW(TrainPcca{}(s.audio, {}, context), std::runtime_error);
  EXPECT_THROW(TrainPcca{}({{"a", s.audio[2]}}, s.visual, context), std::runtime_error) << "60 and 28 frames";
  Track broken = s.visual[1];
  broken.values(4, 1) = NAN;
  EXPECT_THROW(TrainPcca{}(s.audio, {{"b", broken}}, context), std::runtime_error);
}

TEST(ProjectPcca, GivesThePosteriorOfOneStreamOrOfBoth) {
  const Streams s;
  const Pcca model = fit_pcca(s.y, s.z, 2);
  const Track heard = track_of(s.y, {1, 4}), seen = track_of(s.z.topRows(55), {3, 4});
  const Track both = *ProjectPcca{}(model, &heard, &seen), one = *ProjectPcca{}(model, &heard, nullptr),
              other = *ProjectPcca{}(model, nullptr, &seen);
  const Eigen::MatrixXd given_both = model.posterior_mean(s.y, s.z), given_y = model.posterior_mean_of_y(s.y),
                        given_z = model.posterior_mean_of_z(s.z);
  EXPECT_EQ(both.frames(), 55);
  EXPECT_EQ(both.lost, (std::vector<std::int64_t>{4}));
  EXPECT_TRUE(both.values.row(0).isApprox(given_both.row(0), 1e-12));
  EXPECT_TRUE(both.values.row(1).isApprox(given_z.row(1), 1e-12));
  EXPECT_TRUE(both.values.row(3).isApprox(given_y.row(3), 1e-12));
  EXPECT_TRUE(both.values.row(4).isZero());
  EXPECT_TRUE(one.values.row(9).isApprox(given_y.row(9), 1e-12));
  EXPECT_EQ(one.lost, heard.lost);
  EXPECT_TRUE(other.values.row(9).isApprox(given_z.row(9), 1e-12));
  EXPECT_FALSE(ProjectPcca{}(model, nullptr, nullptr));
  EXPECT_THROW(ProjectPcca{}(model, &seen, nullptr), std::runtime_error);
  const Track few = track_of(s.z.topRows(9));
  EXPECT_THROW(ProjectPcca{}(model, &heard, &few), std::runtime_error);
}

TEST(Pcca, StaysFiniteOnDegenerateData) {
  for (const Eigen::Index n : {1, 2, 5}) {
    Eigen::MatrixXd y = gaussian(n, 8, 1), z = gaussian(n, 6, 2);
    y.col(3).setConstant(7);
    EXPECT_TRUE(fit_pcca(y, z, 7).posterior_mean(y, z).allFinite());
    EXPECT_TRUE(fit_pcca(y.setConstant(2), z.setConstant(1), 3).posterior_mean(y, z).isZero(1e-9));
  }
  EXPECT_THROW(fit_pcca(gaussian(3, 2, 1), gaussian(4, 2, 1), 1), std::runtime_error);
  EXPECT_THROW(fit_pcca(Eigen::MatrixXd(0, 2), Eigen::MatrixXd(0, 2), 1), std::runtime_error);
}

TEST(Ppca, RecoversSubspaceAndNoise) {
  const Eigen::Index n = 20000;
  const auto x = gaussian(n, 2, 1), w = gaussian(2, 6, 2);
  const Eigen::MatrixXd y = x * w + 0.5 * gaussian(n, 6, 4);
  const Ppca model = fit_ppca(y, 2);
  EXPECT_LT(distance(model.loadings, w.transpose()), 0.03);
  EXPECT_NEAR(model.noise, 0.25, 0.01);
  EXPECT_TRUE((model.loadings * model.loadings.transpose()).isApprox(w.transpose() * w, 0.05));
  EXPECT_TRUE(fit_ppca(y.topRows(1), 3).posterior_mean(y.topRows(1)).isZero(1e-9));
  EXPECT_TRUE(fit_ppca(y.topRows(3), 9).posterior_mean(y.topRows(3)).allFinite());
}

TEST(Ppca, DensityAndPosteriorAreThoseOfTheDenseGaussian) {
  const Eigen::MatrixXd y = gaussian(60, 2, 1) * gaussian(2, 5, 2) + 0.3 * gaussian(60, 5, 3);
  for (const Eigen::Index d : {1, 2, 5, 7}) {
    const Ppca model = fit_ppca(y, d);
    const Eigen::MatrixXd covariance =
        model.loadings * model.loadings.transpose() + model.noise * Eigen::MatrixXd::Identity(5, 5);
    const Eigen::VectorXd log_likelihood = model.log_likelihood(y);
    for (Eigen::Index i = 0; i < 60; i += 10)
      EXPECT_NEAR(log_likelihood(i), testing::log_normal_density(y.row(i), model.mean, covariance), 1e-9);
    if (d >= 5) continue;  // hardly any noise: the dense form has no digits left
    EXPECT_TRUE(model.posterior_covariance().isApprox(
        Eigen::MatrixXd::Identity(d, d) - model.loadings.transpose() * covariance.inverse() * model.loadings, 1e-9));
  }
}

TEST(Ppca, IsLikelierThanItsNeighbours) {
  const Eigen::MatrixXd y = gaussian(200, 2, 1) * gaussian(2, 5, 2) + 0.5 * gaussian(200, 5, 3);
  const Ppca best = fit_ppca(y, 2);
  const double reached = best.log_likelihood(y).sum();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Ppca other = best;
    other.loadings += 0.02 * gaussian(5, 2, 100 + seed);
    other.noise *= 1 + 0.02 * gaussian(1, 1, 200 + seed)(0);
    EXPECT_LT(other.log_likelihood(y).sum(), reached);
  }
}

TEST(TrainPpca, SaysThatValuesAreHuge) {
  Context context;
  Track huge;
  huge.values = 1e160 * gaussian(20, 3, 1);
  try {
    TrainPpca{}({{"a", huge}}, context);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("huge"), std::string::npos) << e.what();
  }
}

TEST(Ppca, OfDataThatDoNotVaryExplainsOtherFrames) {
  for (const double value : {0.0, 3.3})
    for (const Eigen::Index n : {1, 5}) {
      const Ppca model = fit_ppca(Eigen::MatrixXd::Constant(n, 3, value), 2);
      EXPECT_TRUE(model.log_likelihood(gaussian(4, 3, 1)).allFinite());
      EXPECT_TRUE(model.posterior_mean(gaussian(4, 3, 1)).isZero());
    }
}

TEST(ProjectPpca, GivesPosteriorMeansOfATrack) {
  Context context;
  Track track{gaussian(30, 4, 1), Rational{30}, 0.5, {}, {3}};
  const Ppca model = TrainPpca{2}({{"a", track}}, context);
  const Track latents = ProjectPpca{}(model, track);
  EXPECT_EQ(latents.values, model.posterior_mean(track.values));
  EXPECT_EQ(latents.start, 0.5);
  EXPECT_EQ(latents.lost, track.lost);
  track.values(2, 1) = NAN;
  EXPECT_THROW(ProjectPpca{}(model, track), std::runtime_error);
  EXPECT_THROW(TrainPpca{2}({{"a", track}}, context), std::runtime_error);
  track.values = gaussian(30, 3, 1);
  EXPECT_THROW(ProjectPpca{}(model, track), std::runtime_error);
  EXPECT_THROW(TrainPpca{2}({}, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
