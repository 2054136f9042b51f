#include "nodes/mapping/phone_gaussians.h"

#include <gtest/gtest.h>

#include "nodes/mapping/scaling.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using Phones = std::vector<Eigen::Index>;

const std::vector<std::string> names{"aa", "b", "iy", "sil"};

PhoneGaussians true_model(int order) {
  PhoneGaussians model;
  model.phones = names;
  model.means = gaussian(5, 3, 1);
  model.variances = gaussian(5, 3, 2).cwiseAbs2().array() + 0.1;
  model.smoothness = 2;
  model.order = order;
  model.scaling = {Eigen::RowVectorXd::Zero(3), Eigen::RowVectorXd::Ones(3)};
  return model;
}

/// Phones of one to five frames.
Phones some_phones(Eigen::Index frames, std::uint64_t seed) {
  Random random(seed);
  Phones phones;
  while (std::ssize(phones) < frames)
    phones.insert(phones.end(), 1 + random.below(5), static_cast<Eigen::Index>(random.below(4)));
  phones.resize(static_cast<std::size_t>(frames));
  return phones;
}

FrameLabels labels_of(const Phones& phones) {
  FrameLabels labels;
  for (const auto p : phones) labels.labels.push_back(names[static_cast<std::size_t>(p)]);
  return labels;
}

Eigen::MatrixXd trajectory(const PhoneGaussians& model, const Phones& phones) {
  return SynthesisePhoneGaussians{}(model, labels_of(phones)).values;
}

Track track_of(Eigen::MatrixXd values) {
  Track track;
  track.values = std::move(values);
  return track;
}

struct Corpus {
  Collected<Track> visual;
  Collected<FrameLabels> labels;
};

Corpus drawn_from(const PhoneGaussians& model, int sequences, double noise) {
  Corpus corpus;
  for (int i = 0; i < sequences; ++i) {
    const auto seed = 10 + static_cast<std::uint64_t>(i);
    const Phones phones = some_phones(40, seed);
    corpus.visual.add(std::to_string(i), track_of(trajectory(model, phones) + noise * gaussian(40, 3, seed)));
    corpus.labels.add(std::to_string(i), labels_of(phones));
  }
  return corpus;
}

TEST(PhoneGaussians, DescentFindsTheTrajectoriesThatTheDataWereDrawnFrom) {
  const PhoneGaussians truth = true_model(2);
  const Corpus corpus = drawn_from(truth, 30, 0.1);
  TrainPhoneGaussians train;
  train.smoothness = truth.smoothness;
  train.order = 2;
  train.descent = 200;
  Context context;
  const PhoneGaussians found = train(corpus.visual, corpus.labels, context);
  train.descent = 0;
  const PhoneGaussians untrained = train(corpus.visual, corpus.labels, context);
  const Phones phones = some_phones(200, 1);
  const Eigen::MatrixXd optimal = trajectory(truth, phones);
  const auto error = [&](const PhoneGaussians& model) {
    return (trajectory(model, phones) - optimal).squaredNorm() / 600;
  };
  EXPECT_GT(error(untrained), 0.05);
  EXPECT_LT(error(found), 0.001);
  EXPECT_LT(testing::largest_fall([&] {
              std::vector<double> rising(found.trace);
              for (double& x : rising) x = -x;
              return rising;
            }()),
            1e-12);
  const double deviations = found.scaling.deviation.cwiseInverse().squaredNorm() / 3;
  EXPECT_NEAR(found.trace.back(), 0.01 * deviations, 0.001 * deviations);
}

TEST(PhoneGaussians, RecoverThePhonesThatTheDataWereDrawnFrom) {
  const PhoneGaussians truth = true_model(2);
  const Corpus corpus = drawn_from(truth, 60, 0.02);
  Context context;
  TrainPhoneGaussians train;
  train.smoothness = truth.smoothness;
  train.descent = 400;
  const PhoneGaussians found = train(corpus.visual, corpus.labels, context);
  // A phone has some 600 frames: noise of 0.02 moves its mean by 0.001, and by more where trajectories are smooth.
  EXPECT_LT((restored(found.scaling, found.means.topRows(4)) - truth.means.topRows(4)).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((found.variances.topRows(4).cwiseQuotient(truth.variances.topRows(4)).array() - 1).abs().maxCoeff(), 0.03);
}

TEST(PhoneGaussians, AreMeansAndVariancesBeforeTheDescent) {
  Track visual = track_of(Eigen::VectorXd{{1, 3, 100, 6, 9, 12}});
  visual.lost = {2};
  FrameLabels labels{{"b", "b", "b", "aa", "aa", "aa"}};
  Context context;
  TrainPhoneGaussians train;
  train.descent = 0;
  const PhoneGaussians model = train({{"u", visual}}, {{"u", labels}}, context);
  const double mean = 6.2, variance = (5.2 * 5.2 + 3.2 * 3.2 + 0.2 * 0.2 + 2.8 * 2.8 + 5.8 * 5.8) / 5;
  EXPECT_EQ(model.phones, (std::vector<std::string>{"aa", "b"}));
  EXPECT_NEAR(model.means(0), (9 - mean) / std::sqrt(variance), 1e-12);
  EXPECT_NEAR(model.means(1), (2 - mean) / std::sqrt(variance), 1e-12);
  EXPECT_NEAR(model.variances(0), 6 / variance, 1e-12);
  EXPECT_NEAR(model.variances(1), 1 / variance, 1e-12);
}

TEST(PhoneGaussians, SmoothnessLeadsFromTheMeansToTheirWeightedMean) {
  PhoneGaussians model = true_model(1);
  const Phones phones{0, 0, 0, 0, 1, 2, 2};
  model.smoothness = 1e-12;
  EXPECT_TRUE(trajectory(model, phones).isApprox(model.means(phones, Eigen::all), 1e-9));
  model.smoothness = 1e9;
  // However long it lasts, a phone counts once.
  const Eigen::ArrayXXd precisions = model.variances.topRows(3).cwiseInverse();
  const Eigen::RowVectorXd level =
      (precisions * model.means.topRows(3).array()).colwise().sum() / precisions.colwise().sum();
  EXPECT_TRUE(trajectory(model, phones).isApprox(level.replicate(7, 1), 1e-6));
}

TEST(PhoneGaussians, AnswerWhatTrainingHadNoneOf) {
  const Corpus corpus = drawn_from(true_model(2), 3, 0.1);
  Context context;
  const PhoneGaussians model = TrainPhoneGaussians{}(corpus.visual, corpus.labels, context);
  const SynthesisePhoneGaussians synthesise;
  const Track unknown = synthesise(model, {{"zh", "zh", "oy"}, Rational{50}});
  EXPECT_TRUE(unknown.values.isApprox(model.scaling.mean.replicate(3, 1), 1e-9));
  EXPECT_EQ(unknown.rate.value(), 50);
  EXPECT_EQ(unknown.start, 0.01);
  EXPECT_EQ(synthesise(model, {{"aa"}}).frames(), 1);
  EXPECT_EQ(synthesise(model, FrameLabels{}).values.cols(), 3);
  EXPECT_EQ(synthesise(model, FrameLabels{}).frames(), 0);
}

TEST(PhoneGaussians, AnswerDegenerateTraining) {
  Context context;
  const TrainPhoneGaussians train;
  const auto model = train({{"u", track_of(gaussian(1, 2, 1))}}, {{"u", {{"aa"}}}}, context);
  EXPECT_TRUE(SynthesisePhoneGaussians{}(model, {{"aa", "b"}}).values.allFinite());
  Eigen::MatrixXd constant = gaussian(6, 2, 1);
  constant.col(1).setConstant(0.1);
  const FrameLabels labels{{"aa", "aa", "b", "b", "aa", "iy"}};
  const auto flat = train({{"u", track_of(constant)}}, {{"u", labels}}, context);
  EXPECT_TRUE(SynthesisePhoneGaussians{}(flat, labels).values.col(1).isApproxToConstant(0.1));
  constant(3, 0) = NAN;
  EXPECT_THROW(train({{"u", track_of(constant)}}, {{"u", labels}}, context), std::runtime_error);
  EXPECT_THROW(train({{"u", track_of(gaussian(9, 2, 1))}}, {{"u", labels}}, context), std::runtime_error);
  EXPECT_THROW(train({{"u", track_of(gaussian(6, 2, 1))}}, {{"other", labels}}, context), std::runtime_error);
  EXPECT_THROW(train({}, {}, context), std::runtime_error);
}

TEST(PhoneGaussians, SameBitsEachTime) {
  const Corpus corpus = drawn_from(true_model(2), 3, 0.1);
  Context context;
  const auto train = [&] { return TrainPhoneGaussians{}(corpus.visual, corpus.labels, context); };
  const PhoneGaussians a = train(), b = train();
  EXPECT_EQ(a.means, b.means);
  EXPECT_EQ(a.variances, b.variances);
}

}  // namespace
}  // namespace talkgraph
