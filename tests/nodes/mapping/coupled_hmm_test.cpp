#include "nodes/mapping/coupled_hmm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "nodes/latent/coupled_hmm.h"
#include "nodes/mapping/coupled_hmm_synthesise.h"
#include "nodes/mapping/scaling.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

struct Speech {
  Collected<Track> audio, visual;
};

GaussianMixture state(const Eigen::RowVectorXd& mean, double deviation) {
  return {Eigen::VectorXd::Ones(1), mean, {Eigen::VectorXd::Constant(mean.size(), deviation * deviation)}};
}

/// Sound and face of three states each. The sound goes where the face was, mostly; the face stays or goes round.
CoupledHmm truth() {
  CoupledHmm model;
  model.audio.start = model.visual.start = Eigen::Vector3d::Constant(1.0 / 3);
  model.audio.transitions = model.visual.transitions = Eigen::MatrixXd::Constant(9, 3, 0.05);
  for (Eigen::Index pair = 0; pair < 9; ++pair) {
    const Eigen::Index face = pair / 3;
    model.audio.transitions(pair, face) = 0.9;
    model.visual.transitions(pair, face) = 0.75;
    model.visual.transitions(pair, (face + 1) % 3) = 0.2;
  }
  model.audio_scaling = {Eigen::RowVector2d(0, 0), Eigen::RowVector2d(1, 1)};
  model.visual_scaling = {Eigen::RowVector2d(0, 0), Eigen::RowVector2d(1, 1)};
  for (Eigen::Index k = 0; k < 3; ++k) {
    model.audio.observations.push_back(state(2 * gaussian(3, 2, 1).row(k), 0.5));
    model.visual.observations.push_back(state(30 * gaussian(3, 2, 3).row(k), 3));
  }
  return model;
}

Speech drawn(int utterances, int frames, std::uint64_t seed) {
  const CoupledHmm model = truth();
  Random random(seed);
  const auto next = [&](const Eigen::RowVectorXd& p) {
    const double at = random.uniform();
    return Eigen::Index{at > p(0)} + Eigen::Index{at > p(0) + p(1)};
  };
  Speech speech;
  for (int u = 0; u < utterances; ++u) {
    Track audio, visual;
    audio.values = 0.5 * gaussian(frames, 2, ++seed);
    visual.values = 3 * gaussian(frames, 2, ++seed);
    audio.start = 0.02;
    for (Eigen::Index t = 0, y = 0, z = 0; t < frames; ++t) {
      const Eigen::Index pair = y + 3 * z;
      y = t == 0 ? next(model.audio.start) : next(model.audio.transitions.row(pair));
      z = t == 0 ? next(model.visual.start) : next(model.visual.transitions.row(pair));
      audio.values.row(t) += model.audio.observations[static_cast<std::size_t>(y)].means.row(0);
      visual.values.row(t) += model.visual.observations[static_cast<std::size_t>(z)].means.row(0);
    }
    speech.audio.add("u" + std::to_string(u), audio);
    speech.visual.add("u" + std::to_string(u), visual);
  }
  return speech;
}

TrainCoupledHmm node() {
  TrainCoupledHmm train;
  train.audio_states = train.visual_states = 3;
  train.changes = 0;
  return train;
}

CoupledHmm learn(const Speech& speech, const TrainCoupledHmm& train = node()) {
  Random random(1);
  Context context;
  return train(speech.audio, speech.visual, random, context);
}

double squared_error(const CoupledHmm& model, const Speech& speech, int iterations) {
  double sum = 0;
  for (std::size_t u = 0; u < speech.audio.size(); ++u)
    sum += (SynthesiseCoupledHmm{iterations}(model, speech.audio[u]).values - speech.visual[u].values).squaredNorm();
  return sum;
}

TEST(CoupledHmm, PredictsNearlyAsWellAsTheModelItsDataWereDrawnFrom) {
  const Speech seen = drawn(20, 60, 1), unseen = drawn(10, 60, 1000);
  const CoupledHmm model = learn(seen);
  for (const int iterations : {0, 10})
    EXPECT_LT(squared_error(model, unseen, iterations), 1.1 * squared_error(truth(), unseen, iterations));
  double still = 0;
  for (std::size_t u = 0; u < unseen.visual.size(); ++u)
    still += (unseen.visual[u].values.rowwise() - model.visual_scaling.mean).squaredNorm();
  EXPECT_LT(squared_error(model, unseen, 0), 0.6 * still);
}

/// Which found state has the mean of each true one.
std::vector<Eigen::Index> partners(const CoupledChain& found, const Scaling& scaling, const CoupledChain& chain) {
  std::vector<Eigen::Index> at;
  for (const GaussianMixture& state : chain.observations) {
    Eigen::VectorXd distances(found.states());
    for (Eigen::Index k = 0; k < found.states(); ++k)
      distances(k) = (restored(scaling, found.observations[static_cast<std::size_t>(k)].means) - state.means).norm();
    distances.minCoeff(&at.emplace_back());
  }
  return at;
}

void expect_states(const CoupledChain& found, const Scaling& scaling, const CoupledChain& chain,
                   const std::vector<Eigen::Index>& at) {
  EXPECT_EQ(std::set(at.begin(), at.end()).size(), at.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    const GaussianMixture& state = found.observations[static_cast<std::size_t>(at[k])];
    const Eigen::VectorXd variances = chain.observations[k].covariances[0];
    // A state has 1000 frames or more: a mean is off by 3 % of a deviation, a variance by 4 %.
    EXPECT_LT((restored(scaling, state.means) - chain.observations[k].means).norm(), 0.15 * std::sqrt(variances(0)));
    EXPECT_TRUE(variances.isApprox(state.covariances[0].cwiseProduct(scaling.deviation.transpose().cwiseAbs2()), 0.15));
  }
}

TEST(CoupledHmm, RecoversTheModelItsDataWereDrawnFrom) {
  TrainCoupledHmm train = node();
  train.floor = 1e-4;
  train.tolerance = 1e-6;
  const CoupledHmm best = truth(), model = learn(drawn(100, 60, 1), train);
  const auto sounds = partners(model.audio, model.audio_scaling, best.audio),
             faces = partners(model.visual, model.visual_scaling, best.visual);
  expect_states(model.audio, model.audio_scaling, best.audio, sounds);
  expect_states(model.visual, model.visual_scaling, best.visual, faces);
  // The rarest pairs of states have under 200 of 6000 frames: a probability of 0.75 is off by 0.03.
  for (Eigen::Index pair = 0; pair < 9; ++pair) {
    const Eigen::Index found =
        sounds[static_cast<std::size_t>(pair % 3)] + 3 * faces[static_cast<std::size_t>(pair / 3)];
    const Eigen::RowVectorXd sound = model.audio.transitions(found, sounds),
                             face = model.visual.transitions(found, faces);
    EXPECT_LT((sound - best.audio.transitions.row(pair)).cwiseAbs().maxCoeff(), 0.1) << sound;
    EXPECT_LT((face - best.visual.transitions.row(pair)).cwiseAbs().maxCoeff(), 0.1) << face;
  }
}

TEST(CoupledHmm, HearsChangesOfTheSound) {
  const Speech speech = drawn(3, 40, 5);
  TrainCoupledHmm train = node();
  train.changes = 2;
  const CoupledHmm model = learn(speech, train);
  EXPECT_EQ(model.audio.observations[0].dimension(), 6);
  const Track face = SynthesiseCoupledHmm{}(model, speech.audio[0]);
  EXPECT_EQ(face.frames(), 40);
  EXPECT_EQ(face.dimension(), 2);
  EXPECT_EQ(face.start, 0.02);
  EXPECT_TRUE(face.values.allFinite());
}

TEST(CoupledHmm, DoesNotDependOnUnitsAndRepeatsItsBits) {
  const Speech speech = drawn(4, 40, 3);
  Speech other;
  for (std::size_t u = 0; u < 4; ++u) {
    Track audio = speech.audio[u], visual = speech.visual[u];
    audio.values = (1e3 * audio.values).array() - 50;
    visual.values = (1e-4 * visual.values).array() + 2;
    other.audio.add(speech.audio.key(u), audio);
    other.visual.add(speech.visual.key(u), visual);
  }
  const Eigen::MatrixXd face = SynthesiseCoupledHmm{}(learn(speech), speech.audio[0]).values;
  EXPECT_EQ(SynthesiseCoupledHmm{}(learn(speech), speech.audio[0]).values, face);
  const Eigen::MatrixXd moved = SynthesiseCoupledHmm{}(learn(other), other.audio[0]).values;
  EXPECT_TRUE(moved.isApprox(((1e-4 * face).array() + 2).matrix(), 1e-6));
}

TEST(CoupledHmm, LearnsNothingFromLostFrames) {
  const Speech speech = drawn(2, 40, 3);
  const auto with_lost = [&](double value) {
    Track face = speech.visual[0];
    face.lost = {0, 17, 18};
    for (const Eigen::Index t : face.lost) face.values.row(t).setConstant(value);
    return learn({speech.audio, {{"u0", face}, {"u1", speech.visual[1]}}}).trace;
  };
  EXPECT_EQ(with_lost(0), with_lost(1e9));
  EXPECT_NE(with_lost(0), learn(speech).trace);
}

TEST(CoupledHmm, AnswersHardInput) {
  const Speech speech = drawn(4, 40, 3);
  const CoupledHmm model = learn(speech);
  Track audio = speech.audio[1];
  audio.lost = {9};
  audio.values.row(9).setConstant(1e6);
  EXPECT_LT(SynthesiseCoupledHmm{}(model, audio).values.cwiseAbs().maxCoeff(), 100);
  audio.values.setZero();
  EXPECT_TRUE(SynthesiseCoupledHmm{}(model, audio).values.allFinite());
  audio.lost.clear();
  audio.values.conservativeResize(1, Eigen::NoChange);
  EXPECT_EQ(SynthesiseCoupledHmm{}(model, audio).frames(), 1);
  audio.values(0, 0) = NAN;
  EXPECT_THROW(SynthesiseCoupledHmm{}(model, audio), std::runtime_error);
  audio.values.setZero(3, 5);
  EXPECT_THROW(SynthesiseCoupledHmm{}(model, audio), std::runtime_error);
  audio.values.resize(0, 2);
  EXPECT_EQ(SynthesiseCoupledHmm{}(model, audio).dimension(), 2);
}

TEST(CoupledHmm, AnswersDegenerateTraining) {
  const Speech one = drawn(1, 1, 1);
  EXPECT_TRUE(SynthesiseCoupledHmm{}(learn(one), one.audio[0]).values.isApprox(one.visual[0].values));
  const Speech speech = drawn(2, 30, 1);
  Track still = speech.visual[0];
  still.values.col(1).setConstant(-7);
  const CoupledHmm model = learn({speech.audio, {{"u0", still}}});
  EXPECT_TRUE(SynthesiseCoupledHmm{}(model, speech.audio[0]).values.col(1).isConstant(-7));

  EXPECT_THROW(learn({}), std::runtime_error);
  still.values(2, 1) = NAN;
  EXPECT_THROW(learn({speech.audio, {{"u0", still}}}), std::runtime_error);
  still.values = gaussian(25, 2, 1);
  EXPECT_THROW(learn({speech.audio, {{"u0", still}}}), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
