#include "nodes/mapping/shared_lds.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>

#include "nodes/latent/lds.h"
#include "nodes/mapping/shared_lds_synthesise.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::positive;

/// A damped rotation, heard in three dimensions and seen in two.
Lds truth() {
  Lds model;
  model.prediction.resize(2, 2);
  model.prediction << std::cos(0.4), -std::sin(0.4), std::sin(0.4), std::cos(0.4);
  model.prediction *= 0.95;
  model.offset = Eigen::Vector2d(0.1, -0.2);
  model.prediction_noise = 0.1 * positive(2, 1);
  model.first_mean = Eigen::Vector2d(1, 2);
  model.first_covariance = positive(2, 2);
  model.mean = gaussian(1, 5, 3);
  model.observation = gaussian(5, 2, 4);
  model.observation_noise.setZero(5, 5);
  model.observation_noise.topLeftCorner(3, 3) = 0.3 * positive(3, 5);
  model.observation_noise.bottomRightCorner(2, 2) = 0.2 * positive(2, 6);
  return model;
}

struct Streams {
  Collected<Track> audio, visual;
};

Streams sample(const Lds& model, int sequences, int length, std::uint64_t seed) {
  const auto noise = [&](const Eigen::MatrixXd& covariance) -> Eigen::VectorXd {
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    return root * gaussian(covariance.rows(), 1, ++seed);
  };
  Streams s;
  for (int i = 0; i < sequences; ++i) {
    Eigen::MatrixXd frames(length, 5);
    Eigen::VectorXd x = model.first_mean + noise(model.first_covariance);
    for (int t = 0; t < length; ++t) {
      if (t > 0) x = (model.prediction * x + model.offset + noise(model.prediction_noise)).eval();
      frames.row(t) = model.mean + (model.observation * x + noise(model.observation_noise)).transpose();
    }
    Track audio, visual;
    audio.values = frames.leftCols(3);
    visual.values = frames.rightCols(2);
    s.audio.add(std::to_string(i), std::move(audio));
    s.visual.add(std::to_string(i), std::move(visual));
  }
  return s;
}

double squared_error(const Streams& s, const std::function<Eigen::MatrixXd(const Track&)>& synthesise) {
  double sum = 0, frames = 0;
  for (std::size_t i = 0; i < s.audio.size(); ++i) {
    sum += (synthesise(s.audio[i]) - s.visual[i].values).squaredNorm();
    frames += static_cast<double>(s.audio[i].frames());
  }
  return sum / frames;
}

TrainSharedLds node() {
  TrainSharedLds train;
  train.latent_dimension = 2;
  train.iterations = 200;
  train.tolerance = 1e-6;
  return train;
}

/// The face by the system itself, given the sound.
Eigen::MatrixXd given_sound(const Lds& system, const Track& audio, bool smooth) {
  const Lds of_sound = observed_part(system, 0, 3);
  const LdsPosterior states =
      smooth ? kalman_smoother(of_sound, audio.values) : kalman_filter(of_sound, audio.values, audio.lost);
  return observations(observed_part(system, 3, 2), states.means);
}

TEST(SharedLds, PredictsNearlyAsWellAsTheSystemItsDataWereDrawnFrom) {
  const Lds system = truth();
  Context context;
  const Streams seen = sample(system, 30, 100, 1), unseen = sample(system, 20, 100, 1'000'000);
  const SharedLds model = node()(seen.audio, seen.visual, context);
  double before = std::numeric_limits<double>::infinity();
  for (const bool smooth : {false, true}) {
    const double best = squared_error(unseen, [&](const Track& a) { return given_sound(system, a, smooth); });
    const double found =
        squared_error(unseen, [&](const Track& a) { return SynthesiseSharedLds{smooth}(model, a).values; });
    EXPECT_LT(found, 1.03 * best);
    EXPECT_LT(found, before);
    before = found;
  }
}

/// As its streams' units have it, not scaled.
Lds in_units(SharedLds model) {
  Eigen::VectorXd deviations(model.audio.deviation.size() + model.visual.deviation.size());
  deviations << model.audio.deviation.transpose(), model.visual.deviation.transpose();
  model.system.observation = deviations.asDiagonal() * model.system.observation;
  model.system.observation_noise = deviations.asDiagonal() * model.system.observation_noise * deviations.asDiagonal();
  return model.system;
}

TEST(SharedLds, RecoversTheSystemItsDataWereDrawnFrom) {
  const Lds system = truth();
  Context context;
  const Streams drawn = sample(system, 40, 100, 1);
  const Lds found = in_units(node()(drawn.audio, drawn.visual, context));
  // States are known up to a linear map: poles and what is observed of a shock k frames later are not. Of 4000 frames a
  // pole has a deviation of √((1 − 0.95²)/4000) = 0.005, a variance one of √(2/4000) = 2 %, and more as states are
  // hidden.
  const std::complex<double> pole = found.prediction.eigenvalues()(0);
  EXPECT_NEAR(std::abs(pole), 0.95, 0.015);
  EXPECT_NEAR(std::abs(std::arg(pole)), 0.4, 0.015);
  EXPECT_TRUE(found.observation_noise.isApprox(system.observation_noise, 0.1));
  for (const int k : {0, 1, 4, 8}) {
    const auto response = [k](const Lds& m) {
      Eigen::MatrixXd moved = m.prediction_noise * m.observation.transpose();
      for (int i = 0; i < k; ++i) moved = m.prediction * moved;
      return Eigen::MatrixXd(m.observation * moved);
    };
    EXPECT_TRUE(response(found).isApprox(response(system), 0.15)) << k;
  }
}

TEST(SharedLds, NoisesOfSoundAndFaceAreApartAndTheLikelihoodNeverFalls) {
  Context context;
  Streams s = sample(truth(), 3, 40, 7);
  for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal}) {
    TrainSharedLds train = node();
    train.covariance = kind;
    const Lds system = train(s.audio, s.visual, context).system;
    EXPECT_GT(system.trace.size(), 3U);
    EXPECT_LT(testing::largest_fall(system.trace), 1e-10);
    if (kind == CovarianceKind::diagonal) continue;
    EXPECT_TRUE(system.observation_noise.topRightCorner(3, 2).isZero(0));
    EXPECT_TRUE(system.observation_noise.bottomLeftCorner(2, 3).isZero(0));
    EXPECT_GT(
        system.observation_noise.topLeftCorner(3, 3).triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm(),
        0.01);
  }
}

TEST(SharedLds, DoesNotDependOnUnitsAndRepeatsItsBits) {
  Context context;
  const Streams s = sample(truth(), 4, 50, 3);
  Streams other;
  for (std::size_t i = 0; i < s.audio.size(); ++i) {
    Track audio = s.audio[i], visual = s.visual[i];
    audio.values = (1e3 * audio.values).array() - 50;
    visual.values = (1e-4 * visual.values).array() + 2;
    other.audio.add(s.audio.key(i), audio);
    other.visual.add(s.visual.key(i), visual);
  }
  const SharedLds model = node()(s.audio, s.visual, context), again = node()(s.audio, s.visual, context);
  EXPECT_EQ(model.system.prediction, again.system.prediction);
  const SharedLds moved = node()(other.audio, other.visual, context);
  const Eigen::MatrixXd face = SynthesiseSharedLds{}(model, s.audio[0]).values;
  const Eigen::MatrixXd moved_face = SynthesiseSharedLds{}(moved, other.audio[0]).values;
  EXPECT_TRUE(moved_face.isApprox(((1e-4 * face).array() + 2).matrix(), 1e-6));
}

TEST(SharedLds, LearnsNothingFromLostFramesAndBridgesLostSound) {
  Context context;
  Streams s = sample(truth(), 2, 60, 5);
  Track face = s.visual[1];
  face.values.row(20).setConstant(1e6);
  face.lost = {20};
  Streams lost = s;
  lost.visual = {{"0", s.visual[0]}, {"1", face}};
  const SharedLds model = node()(lost.audio, lost.visual, context);
  EXPECT_LT(model.visual.deviation.maxCoeff(), 100);
  Track sound = s.audio[0];
  sound.values.row(9).setConstant(1e6);
  sound.lost = {9};
  EXPECT_LT(SynthesiseSharedLds{true}(model, sound).values.cwiseAbs().maxCoeff(), 100);
}

TEST(SharedLds, AnswersDegenerateData) {
  Context context;
  Streams one = sample(truth(), 1, 1, 1);
  Track sound = one.audio[0];
  sound.rate = Rational(30);
  sound.start = 0.5;
  const Track face = SynthesiseSharedLds{}(TrainSharedLds{}(one.audio, one.visual, context), sound);
  EXPECT_TRUE(face.values.isApprox(one.visual[0].values, 1e-9));
  EXPECT_EQ(face.rate, Rational(30));
  EXPECT_EQ(face.start, 0.5);

  Streams still = sample(truth(), 2, 30, 1);
  Track silence = still.audio[1];
  silence.values.setConstant(-7);
  still.audio = {{"0", silence}, {"1", silence}};
  const SharedLds deaf = node()(still.audio, still.visual, context);
  EXPECT_TRUE(SynthesiseSharedLds{true}(deaf, silence).values.allFinite());

  silence.values.resize(0, 3);
  const Track none = SynthesiseSharedLds{}(deaf, silence);
  EXPECT_EQ(none.frames(), 0);
  EXPECT_EQ(none.dimension(), 2);
}

std::string message(const std::function<void()>& what) {
  try {
    what();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(SharedLds, RefusesWhatItCannotUse) {
  Context context;
  const Streams s = sample(truth(), 2, 30, 1);
  const auto train = [&](const Collected<Track>& audio, const Collected<Track>& visual) {
    return message([&] { node()(audio, visual, context); });
  };
  EXPECT_NE(train(s.audio, {}).find("no training sequence"), std::string::npos);
  Track wrong = s.audio[1];
  wrong.values(3, 1) = NAN;
  EXPECT_NE(train({{"0", s.audio[0]}, {"1", wrong}}, s.visual).find("\"1\" has a value that is not finite in frame 3"),
            std::string::npos);
  wrong.values = gaussian(30, 4, 1);
  EXPECT_NE(train({{"0", s.audio[0]}, {"1", wrong}}, s.visual).find("1: 4 audio dimensions"), std::string::npos);
  wrong.values = gaussian(27, 3, 1);
  EXPECT_NE(train({{"1", wrong}}, s.visual).find("1: 27 audio frames, 30 visual frames"), std::string::npos);
  wrong.values = gaussian(28, 3, 1);
  EXPECT_EQ(train({{"1", wrong}}, s.visual), "");

  const SharedLds model = node()(s.audio, s.visual, context);
  wrong.values(0, 0) = NAN;
  EXPECT_THROW(SynthesiseSharedLds{}(model, wrong), std::runtime_error);
  wrong.values = gaussian(5, 2, 1);
  EXPECT_THROW(SynthesiseSharedLds{}(model, wrong), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
