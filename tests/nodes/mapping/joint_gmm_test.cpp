#include "nodes/mapping/joint_gmm.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Track track_of(Eigen::MatrixXd values) {
  Track track;
  track.values = std::move(values);
  return track;
}

/// Two kinds of sound, each of which moves the face its own way.
JointGmm two_components() {
  JointGmm model;
  model.audio = {Eigen::RowVectorXd::Zero(2), Eigen::RowVectorXd::Ones(2)};
  model.visual = {Eigen::RowVectorXd::Zero(3), Eigen::RowVectorXd::Ones(3)};
  model.sound.weights = Eigen::Vector2d(0.5, 0.5);
  model.sound.means.setZero(2, 4);
  model.sound.means.leftCols(2) << -3, -3, 3, 3;
  model.sound.covariances.assign(2, Eigen::Vector4d(1, 1, 2, 2).asDiagonal());
  for (std::uint64_t m = 0; m < 2; ++m) {
    Eigen::MatrixXd regression = Eigen::MatrixXd::Zero(6, 4);
    regression.topLeftCorner(3, 2) = regression.bottomRightCorner(3, 2) = gaussian(3, 2, 5 + m);
    model.regressions.push_back(regression);
  }
  model.means = Eigen::MatrixXd::Zero(2, 6);
  model.means.leftCols(3) = gaussian(2, 3, 8);
  model.variances = Eigen::MatrixXd::Constant(2, 6, 0.1);
  return model;
}

/// Sound that changes its kind every few frames.
Eigen::MatrixXd some_sound(Eigen::Index frames, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd audio = gaussian(frames, 2, seed);
  double level = 3;
  for (Eigen::Index t = 0; t < frames; ++t) {
    if (random.below(6) == 0) level = -level;
    audio.row(t).array() += level;
  }
  return audio;
}

struct Corpus {
  Collected<Track> audio, visual;
};

Corpus drawn_from(const JointGmm& model, int sequences, double noise) {
  Corpus corpus;
  for (int i = 0; i < sequences; ++i) {
    const auto seed = 10 * static_cast<std::uint64_t>(i) + 1;
    const Track audio = track_of(some_sound(60, seed));
    Track visual = SynthesiseJointGmm{}(model, audio);
    visual.values += noise * gaussian(60, 3, seed + 1);
    corpus.audio.add(std::to_string(i), audio);
    corpus.visual.add(std::to_string(i), visual);
  }
  return corpus;
}

JointGmm trained(const TrainJointGmm& train, const Corpus& corpus) {
  Random random(1);
  Context context;
  return train(corpus.audio, corpus.visual, random, context);
}

TEST(JointGmm, DescentComesCloserToTheTrajectoriesThatTheDataWereDrawnFrom) {
  const JointGmm truth = two_components();
  const Corpus corpus = drawn_from(truth, 30, 0.1);
  const Track sound = track_of(some_sound(500, 999));
  const Eigen::MatrixXd optimal = SynthesiseJointGmm{}(truth, sound).values;
  const double spread = (optimal.rowwise() - optimal.colwise().mean()).squaredNorm();
  const auto error = [&](const JointGmm& model) {
    return (SynthesiseJointGmm{}(model, sound).values - optimal).squaredNorm() / spread;
  };
  const JointGmm likeliest = trained({.components = 2, .descent = 0}, corpus),
                 refined = trained({.components = 2, .descent = 100}, corpus);
  EXPECT_LT(error(refined), 0.02);
  EXPECT_LT(error(refined), error(likeliest));
  EXPECT_LT(testing::largest_fall(refined.trace), 1e-12);
  for (std::size_t i = 1; i < refined.errors.size(); ++i) EXPECT_LE(refined.errors[i], refined.errors[i - 1]);
  EXPECT_EQ(likeliest.errors.size(), 1U);
  EXPECT_EQ(likeliest.errors[0], refined.errors[0]);
}

/// Over sound and face with their slopes, as their units have them.
GaussianMixture in_units(const JointGmm& model) {
  const Eigen::Index heard = model.sound.dimension(), seen = model.means.cols();
  Eigen::RowVectorXd deviations(heard + seen), means = Eigen::RowVectorXd::Zero(heard + seen);
  deviations << model.audio.deviation, model.audio.deviation, model.visual.deviation, model.visual.deviation;
  means.head(heard / 2) = model.audio.mean;
  means.segment(heard, seen / 2) = model.visual.mean;
  GaussianMixture joint{model.sound.weights, Eigen::MatrixXd(model.sound.components(), heard + seen), {}};
  for (Eigen::Index m = 0; m < joint.components(); ++m) {
    const Eigen::MatrixXd& regression = model.regressions[static_cast<std::size_t>(m)];
    const Eigen::MatrixXd& of_sound = model.sound.covariances[static_cast<std::size_t>(m)];
    joint.means.row(m) << model.sound.means.row(m),
        model.means.row(m) + model.sound.means.row(m) * regression.transpose();
    joint.means.row(m) = joint.means.row(m).cwiseProduct(deviations) + means;
    Eigen::MatrixXd covariance(heard + seen, heard + seen);
    covariance << of_sound, of_sound * regression.transpose(), regression * of_sound,
        regression * of_sound * regression.transpose();
    covariance.diagonal().tail(seen) += model.variances.row(m).transpose();
    joint.covariances.push_back(deviations.asDiagonal() * covariance * deviations.asDiagonal());
  }
  return joint;
}

TEST(JointGmm, RecoversTheMixtureItsDataWereDrawnFrom) {
  // Every utterance is of one component, so that slopes too are Gaussian: with half the covariance of the frames.
  const Eigen::Index frames = 400, utterances = 30;
  std::vector<Eigen::MatrixXd> roots;
  Eigen::MatrixXd means(2, 4);
  means << 0, 0, 5, 5, 2, -1, 6, 2;
  for (std::uint64_t m = 0; m < 2; ++m) {
    Eigen::MatrixXd covariance = testing::positive(4, 20 + m, 0.3);
    // Given the sound, dimensions of the face are independent.
    const Eigen::MatrixXd regression = covariance.bottomLeftCorner(2, 2) * covariance.topLeftCorner(2, 2).inverse();
    covariance.bottomRightCorner(2, 2) =
        regression * covariance.topRightCorner(2, 2) + Eigen::MatrixXd(Eigen::Vector2d(0.3, 0.6).asDiagonal());
    roots.push_back(covariance.llt().matrixL());
  }
  Corpus corpus;
  for (Eigen::Index u = 0; u < utterances; ++u) {
    const Eigen::Index m = u % 3 == 0;
    const Eigen::MatrixXd both =
        (gaussian(frames, 4, 70 + static_cast<std::uint64_t>(u)) * roots[static_cast<std::size_t>(m)].transpose())
            .rowwise() +
        means.row(m);
    corpus.audio.add(std::to_string(u), track_of(both.leftCols(2)));
    corpus.visual.add(std::to_string(u), track_of(both.rightCols(2)));
  }
  const GaussianMixture found = in_units(trained({.components = 2, .iterations = 100, .descent = 0}, corpus));
  const std::vector<Eigen::Index> framed{0, 1, 4, 5}, sloped{2, 3, 6, 7};
  for (Eigen::Index m = 0; m < 2; ++m) {
    Eigen::Index at = 0;
    (found.means(Eigen::all, framed).rowwise() - means.row(m)).rowwise().norm().minCoeff(&at);
    const Eigen::MatrixXd& root = roots[static_cast<std::size_t>(m)];
    const Eigen::MatrixXd truth = root * root.transpose(), covariance = found.covariances[static_cast<std::size_t>(at)];
    // The rarer component has 4000 frames: a mean is off by 1.6 % of a deviation, a variance by 2 %.
    EXPECT_NEAR(found.weights(at), m == 0 ? 2.0 / 3 : 1.0 / 3, 0.02);
    EXPECT_LT((found.means(at, framed) - means.row(m)).norm(), 0.15);
    EXPECT_LT(found.means(at, sloped).norm(), 0.1);
    EXPECT_TRUE(covariance(framed, framed).isApprox(truth, 0.1));
    EXPECT_TRUE(covariance(sloped, sloped).isApprox(truth / 2, 0.1));
    EXPECT_LT(covariance(framed, sloped).norm(), 0.1 * truth.norm());
  }
}

TEST(JointGmm, OfOneComponentIsLinearRegression) {
  Corpus corpus;
  const Eigen::MatrixXd weights = gaussian(2, 3, 2);
  for (int i = 0; i < 4; ++i) {
    const Eigen::MatrixXd audio = gaussian(50, 2, static_cast<std::uint64_t>(i));
    corpus.audio.add(std::to_string(i), track_of(audio));
    corpus.visual.add(std::to_string(i), track_of((audio * weights).array() + 4));
  }
  const JointGmm model = trained({.components = 1, .floor = 1e-9}, corpus);
  const Track sound = track_of(gaussian(30, 2, 77));
  const Eigen::MatrixXd expected = (sound.values * weights).array() + 4;
  EXPECT_LT((SynthesiseJointGmm{}(model, sound).values - expected).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(JointGmm, ConditionsTheFaceOnTheSound) {
  const Corpus corpus = drawn_from(two_components(), 3, 0.5);
  const JointGmm model = trained({.components = 1, .floor = 1e-6, .descent = 0}, corpus);
  // Least squares of the scaled face with its slopes on the sound with its.
  const auto with_slopes = [](const Scaling& scaling, const Collected<Track>& tracks) {
    const Eigen::Index dims = scaling.mean.size();
    Eigen::MatrixXd all(180, 2 * dims);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::MatrixXd z =
          (tracks[i].values.rowwise() - scaling.mean) * scaling.deviation.cwiseInverse().asDiagonal();
      for (Eigen::Index t = 0; t < 60; ++t)
        all.row(60 * static_cast<Eigen::Index>(i) + t) << z.row(t),
            0.5 * (z.row(std::min<Eigen::Index>(t + 1, 59)) - z.row(std::max<Eigen::Index>(t - 1, 0)));
    }
    return all;
  };
  Eigen::MatrixXd x(180, 5);
  x << with_slopes(model.audio, corpus.audio), Eigen::VectorXd::Ones(180);
  const Eigen::MatrixXd y = with_slopes(model.visual, corpus.visual), weights = x.colPivHouseholderQr().solve(y);
  EXPECT_TRUE(model.regressions[0].isApprox(weights.topRows(4).transpose(), 1e-6));
  EXPECT_LT((model.means - weights.bottomRows(1)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_TRUE(model.variances.isApprox((y - x * weights).colwise().squaredNorm() / 180, 1e-6));
}

TEST(JointGmm, LearnsFromMeasuredFramesAlone) {
  Corpus corpus = drawn_from(two_components(), 2, 0.1);
  Track visual = corpus.visual[0];
  visual.lost = {20, 21};
  const Track other = corpus.visual[1];
  corpus.visual = {{"0", visual}, {"1", other}};
  const JointGmm model = trained({.components = 2}, corpus);
  visual.values.row(20).setConstant(1e6);
  corpus.visual = {{"0", visual}, {"1", other}};
  EXPECT_EQ(trained({.components = 2}, corpus).means, model.means);
}

TEST(JointGmm, AnswersDegenerateInput) {
  const auto face_of = [](const Eigen::MatrixXd& audio, const Eigen::MatrixXd& visual) {
    const JointGmm model = trained({}, {{{"u", track_of(audio)}}, {{"u", track_of(visual)}}});
    EXPECT_EQ(SynthesiseJointGmm{}(model, track_of(audio.topRows(0))).values.cols(), visual.cols());
    return SynthesiseJointGmm{}(model, track_of(audio)).values;
  };
  const Eigen::MatrixXd few = gaussian(6, 3, 1), one = gaussian(1, 3, 1);
  EXPECT_TRUE(face_of(one, one).isApprox(one));
  EXPECT_TRUE(face_of(few, few).allFinite());
  EXPECT_TRUE(face_of(Eigen::MatrixXd::Zero(6, 3), few).allFinite());
  Eigen::MatrixXd constant = few;
  constant.col(1).setConstant(0.3);
  EXPECT_TRUE(face_of(few, constant).col(1).isApproxToConstant(0.3));
}

TEST(JointGmm, SaysWhereItCannotLearnOrSpeak) {
  Track good = track_of(gaussian(9, 2, 1)), bad = good;
  bad.values(4, 1) = NAN;
  const auto train = [](const Track& audio, const Track& visual, const char* key = "u") {
    return trained({}, {{{"u", audio}}, {{key, visual}}});
  };
  EXPECT_THROW(train(bad, good), std::runtime_error);
  EXPECT_THROW(train(good, bad), std::runtime_error);
  EXPECT_THROW(train(good, good, "other"), std::runtime_error);
  EXPECT_THROW(train(good, track_of(gaussian(12, 2, 1))), std::runtime_error);
  EXPECT_THROW(trained({}, {}), std::runtime_error);
  const JointGmm model = train(good, good);
  EXPECT_THROW(SynthesiseJointGmm{}(model, bad), std::runtime_error);
  EXPECT_THROW(SynthesiseJointGmm{}(model, track_of(gaussian(3, 3, 1))), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
