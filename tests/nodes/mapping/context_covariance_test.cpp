#include "nodes/mapping/context_covariance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/latent/cholesky.h"
#include "nodes/mapping/context_frames.h"
#include "tests/nodes/mapping/context_corpus.h"

namespace talkgraph {
namespace {

using ::testing::ElementsAre;
using testing::random_corpus;
using testing::rbf;
using testing::stacked;

const TrainContextGp node{.reach = 2, .noise = 0.3};
const std::vector<Eigen::Index> rows{1, 5, 11, 12, 20};

ContextGp learnt() { return random_corpus().learn(node); }

/// All training frames.
Eigen::MatrixXd kernel_by_hand(const ContextGp& model) {
  const auto corpus = random_corpus();
  const auto described = [&](std::size_t u) {
    const Eigen::MatrixXd a = corpus.audio[u].values;
    return stacked(node, ((a.rowwise() - model.audio_mean).array().rowwise() * model.audio_scale.array()).matrix(),
                   phone_shares(corpus.phones[u], model.phones, corpus.audio[u]));
  };
  const Eigen::MatrixXd a = described(0), b = described(1);
  Eigen::MatrixXd x(a.rows() + b.rows(), a.cols());
  x << a, b;
  return rbf(x, x);
}

TEST(ContextCovariance, GoesByUtterance) {
  const auto model = learnt();
  const auto blocks = blocks_of(model, rows);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[1].utterance, 1u);
  EXPECT_EQ(blocks[1].at, 3);
  EXPECT_THAT(blocks[0].local, ElementsAre(1, 5, 11));
  EXPECT_THAT(blocks[1].local, ElementsAre(0, 8));
  EXPECT_EQ(blocks[1].frames, model.frames.bottomRows(9));
  const auto second = blocks_of(model, {12});
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].utterance, 1u);
  EXPECT_TRUE(blocks_of(model, {}).empty());
}

TEST(ContextCovariance, IsFactorisedWithItsNoise) {
  const auto model = learnt();
  Context context;
  const Eigen::MatrixXd l = covariance_factor(model, rows, context).triangularView<Eigen::Lower>();
  Eigen::MatrixXd expected = kernel_by_hand(model)(rows, rows);
  expected.diagonal().array() += 0.3;
  EXPECT_LT((l * l.transpose() - expected).norm(), 1e-12 * expected.norm());
  EXPECT_EQ(covariance_factor(model, {}, context).size(), 0);
}

TEST(ContextCovariance, IsThatOfAllTrainingFrames) {
  const auto model = learnt();
  const Eigen::MatrixXd k = kernel_with_training(model, model.frames.bottomRows(9), {0, 8});
  const Eigen::MatrixXd expected = kernel_by_hand(model)(std::vector{12, 20}, Eigen::all);
  EXPECT_LT((k - expected).norm(), 1e-12 * expected.norm());
}

TEST(ContextCovariance, NeedsNoise) {
  auto model = learnt();
  model.noise = -1;
  Context context;
  EXPECT_THROW(covariance_factor(model, rows, context), FactorisationError);
}

}  // namespace
}  // namespace talkgraph
