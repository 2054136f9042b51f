#include "nodes/mapping/windowed_cca.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Track track_of(Eigen::MatrixXd values) {
  Track track;
  track.values = std::move(values);
  return track;
}

struct Corpus {
  Collected<Track> audio, visual;
};

/// A face that follows the sound, with noise.
Eigen::MatrixXd follow(const Eigen::MatrixXd& audio, double noise, std::uint64_t seed) {
  return (audio * gaussian(4, 3, 50) + noise * gaussian(audio.rows(), 3, seed)).array() + 7;
}

Corpus drawn(int sequences, Eigen::Index frames, double noise) {
  Corpus corpus;
  for (int i = 0; i < sequences; ++i) {
    const auto seed = 10 * static_cast<std::uint64_t>(i) + 1;
    const Eigen::MatrixXd audio = gaussian(frames, 4, seed).array() + 2;
    corpus.audio.add(std::to_string(i), track_of(audio));
    corpus.visual.add(std::to_string(i), track_of(follow(audio, noise, seed + 1)));
  }
  return corpus;
}

TEST(WindowedCca, WithAllVariatesIsLeastSquares) {
  const Corpus corpus = drawn(1, 60, 2);
  Context context;
  const auto model = TrainWindowedCca{.context = 0, .dimensions = 3}(corpus.audio, corpus.visual, context);
  Eigen::MatrixXd inputs(60, 5);
  inputs << corpus.audio[0].values, Eigen::VectorXd::Ones(60);
  const Eigen::MatrixXd weights = inputs.colPivHouseholderQr().solve(corpus.visual[0].values);
  EXPECT_TRUE(SynthesiseWindowedCca{}(model, corpus.audio[0]).values.isApprox(inputs * weights, 1e-9));
}

TEST(WindowedCca, RecoversAFaceThatFollowsTheSound) {
  const Corpus corpus = drawn(20, 100, 0.3);
  Context context;
  const auto model = TrainWindowedCca{.context = 2, .dimensions = 20}(corpus.audio, corpus.visual, context);
  const Eigen::MatrixXd audio = gaussian(500, 4, 999).array() + 2;
  const Eigen::MatrixXd optimal = follow(audio, 0, 1), found = SynthesiseWindowedCca{}(model, track_of(audio)).values;
  EXPECT_LT((found - optimal).squaredNorm() / 1500, 0.01);
  EXPECT_GT(model.correlations(0), 0.99);
  EXPECT_TRUE(std::is_sorted(model.correlations.begin(), model.correlations.end(), std::greater<>()));
}

TEST(WindowedCca, RecoversTheCorrelationsAndTheRegressionThatTheDataWereDrawnWith) {
  // Variates u of the sound and ρ u + √(1 − ρ²) noise of the face, each seen through a mixing matrix.
  const Eigen::RowVector3d correlations(0.95, 0.7, 0.3);
  const Eigen::MatrixXd heard = gaussian(4, 4, 61), shown = gaussian(3, 3, 62);
  Corpus corpus;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Eigen::MatrixXd sound = gaussian(200, 4, 3 * i),
                          face = sound.leftCols(3) * correlations.asDiagonal() +
                                 gaussian(200, 3, 3 * i + 1) *
                                     (1 - correlations.array().square()).sqrt().matrix().asDiagonal();
    corpus.audio.add(std::to_string(i), track_of(sound * heard));
    corpus.visual.add(std::to_string(i), track_of(face * shown));
  }
  Context context;
  for (const int reach : {0, 1})
    for (const Eigen::Index variates : {1, 2, 3}) {
      const Eigen::Index frames = 2 * reach + 1;
      const auto model =
          TrainWindowedCca{reach, static_cast<int>(frames * variates)}(corpus.audio, corpus.visual, context);
      // Frames are independent, so that each correlation is that of as many variates as a window has frames; of 8000
      // frames one of 0.3 is off by 0.01, and more where three are sorted.
      for (Eigen::Index i = 0; i < frames * variates; ++i)
        EXPECT_NEAR(model.correlations(i), correlations(i / frames), 0.04);
      const Eigen::MatrixXd sound = gaussian(50, 4, 999);
      const Eigen::MatrixXd face =
          sound.leftCols(variates) * correlations.head(variates).asDiagonal() * shown.topRows(variates);
      const Eigen::MatrixXd found = SynthesiseWindowedCca{}(model, track_of(sound * heard)).values;
      EXPECT_LT((found - face).norm(), 0.05 * face.norm());
    }
}

TEST(WindowedCca, FramesAreMeansOverTheWindowsThatHoldThem) {
  const Corpus corpus = drawn(3, 30, 1);
  Context context;
  const auto model = TrainWindowedCca{.context = 2, .dimensions = 4}(corpus.audio, corpus.visual, context);
  const Track audio = track_of(gaussian(7, 4, 3));
  const Track found = SynthesiseWindowedCca{}(model, audio);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(7, 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(7);
  for (Eigen::Index t = 0; t < 7; ++t) {
    Eigen::RowVectorXd window(20);
    for (Eigen::Index i = 0; i < 5; ++i)
      window.segment(4 * i, 4) =
          (audio.values.row(std::clamp<Eigen::Index>(t + i - 2, 0, 6)) - model.audio.mean).array() /
          model.audio.deviation.array();
    const Eigen::RowVectorXd seen = (window - model.audio_mean) * model.directions * model.weights + model.visual_mean;
    for (Eigen::Index i = 0; i < 5; ++i)
      if (const Eigen::Index at = t + i - 2; at >= 0 && at < 7) {
        const Eigen::RowVectorXd frame = seen.segment(3 * i, 3).array() * model.visual.deviation.array();
        sum.row(at) += frame + model.visual.mean;
        ++count(at);
      }
  }
  EXPECT_TRUE(found.values.isApprox(count.cwiseInverse().asDiagonal() * sum, 1e-12));
}

TEST(WindowedCca, LearnsFromNoWindowWithALostFrame) {
  Corpus corpus = drawn(1, 40, 1);
  Context context;
  Track visual = corpus.visual[0];
  visual.lost = {20};
  const TrainWindowedCca train{.context = 1, .dimensions = 3};
  const auto model = train(corpus.audio, {{"0", visual}}, context);
  visual.values.row(20).setConstant(1e6);
  const auto same = train(corpus.audio, {{"0", visual}}, context);
  EXPECT_EQ(model.weights, same.weights);
  for (std::int64_t t = 0; t < 40; t += 2) visual.lost.push_back(t);
  std::sort(visual.lost.begin(), visual.lost.end());
  visual.lost.erase(std::unique(visual.lost.begin(), visual.lost.end()), visual.lost.end());
  EXPECT_THROW(train(corpus.audio, {{"0", visual}}, context), std::runtime_error);
}

TEST(WindowedCca, AnswersDegenerateInput) {
  Context context;
  const auto face_of = [&](const Eigen::MatrixXd& audio, const Eigen::MatrixXd& visual) {
    const auto model = TrainWindowedCca{}({{"u", track_of(audio)}}, {{"u", track_of(visual)}}, context);
    EXPECT_EQ(SynthesiseWindowedCca{}(model, track_of(audio.topRows(0))).values.cols(), visual.cols());
    return SynthesiseWindowedCca{}(model, track_of(audio)).values;
  };
  const Eigen::MatrixXd few = gaussian(6, 3, 1), one = gaussian(1, 3, 1);
  EXPECT_TRUE(face_of(one, one).isApprox(one));
  EXPECT_TRUE(face_of(few, few).allFinite());
  EXPECT_TRUE(face_of(Eigen::MatrixXd::Zero(6, 3), few).allFinite());
  Eigen::MatrixXd constant = few;
  constant.col(1).setConstant(0.3);
  EXPECT_TRUE(face_of(few, constant).col(1).isApproxToConstant(0.3));
}

TEST(WindowedCca, SaysWhereItCannotLearnOrSpeak) {
  Context context;
  const TrainWindowedCca train;
  Track good = track_of(gaussian(9, 2, 1)), bad = good;
  bad.values(4, 1) = NAN;
  EXPECT_THROW(train({{"u", bad}}, {{"u", good}}, context), std::runtime_error);
  EXPECT_THROW(train({{"u", good}}, {{"u", bad}}, context), std::runtime_error);
  EXPECT_THROW(train({{"u", good}}, {{"other", good}}, context), std::runtime_error);
  EXPECT_THROW(train({{"u", good}}, {{"u", track_of(gaussian(12, 2, 1))}}, context), std::runtime_error);
  EXPECT_THROW(train({}, {}, context), std::runtime_error);
  const auto model = train({{"u", good}}, {{"u", good}}, context);
  EXPECT_THROW(SynthesiseWindowedCca{}(model, bad), std::runtime_error);
  EXPECT_THROW(SynthesiseWindowedCca{}(model, track_of(gaussian(3, 3, 1))), std::runtime_error);
  good.rate = Rational{50};
  good.start = 0.25;
  EXPECT_EQ(SynthesiseWindowedCca{}(model, good).rate.value(), 50);
  EXPECT_EQ(SynthesiseWindowedCca{}(model, good).start, 0.25);
}

}  // namespace
}  // namespace talkgraph
