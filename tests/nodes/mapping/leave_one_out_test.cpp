#include "nodes/mapping/leave_one_out.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "nodes/mapping/context_frames.h"
#include "tests/nodes/mapping/context_corpus.h"

namespace talkgraph {
namespace {

using testing::ContextCorpus;
using testing::gaussian;
using testing::random_corpus;
using testing::rbf;
using testing::said;
using testing::stacked;
using testing::track;

TEST(LeaveOneOut, IsAsIfItWereNotThere) {
  auto corpus = random_corpus();
  corpus.add("c", track(gaussian(7, 3, 6)), said({{"ih", 7}}), track(gaussian(7, 2, 9)));
  const TrainContextGp node{.reach = 2, .noise = 0.3};
  Context context;
  const auto held = leave_one_out(node, corpus.audio, corpus.phones, corpus.visual, context);
  ASSERT_EQ(held.size(), 3u);
  // The other two by the textbook, with the scaling, the phones and the mean of all three.
  const auto model = corpus.learn(node);
  const auto described = [&](std::size_t u) {
    const Eigen::MatrixXd a = corpus.audio[u].values;
    return stacked(node, ((a.rowwise() - model.audio_mean).array().rowwise() * model.audio_scale.array()).matrix(),
                   phone_shares(corpus.phones[u], model.phones, corpus.audio[u]));
  };
  const Eigen::MatrixXd a = described(0), b = described(1), c = described(2);
  Eigen::MatrixXd x(19, a.cols()), z(19, 2);
  x << a, c;
  z << corpus.visual[0].values, corpus.visual[2].values;
  const Eigen::MatrixXd expected =
      (rbf(b, x) * (rbf(x, x) + 0.3 * Eigen::MatrixXd::Identity(19, 19)).fullPivLu().solve(z.rowwise() - model.mean))
          .rowwise() +
      model.mean;
  EXPECT_EQ(held[1].key, "b");
  ASSERT_EQ(held[1].predicted.rows(), 9);
  EXPECT_LT((held[1].predicted - expected).norm(), 1e-9 * expected.norm());
}

TEST(LeaveOneOut, SaysNothingOfWhatIsNotLearnt) {
  auto corpus = random_corpus();
  Track lost = track(gaussian(4, 2, 9));
  lost.lost = {0, 1, 2, 3};
  corpus.add("c", track(gaussian(4, 3, 6)), said({{"b", 4}}), lost);
  Context context;
  const auto held = leave_one_out({}, corpus.audio, corpus.phones, corpus.visual, context);
  EXPECT_EQ(held[2].key, "c");
  EXPECT_TRUE(held[2].frames.empty());
  EXPECT_EQ(held[2].predicted.rows(), 0);
}

TEST(LeaveOneOut, NeedsOthers) {
  const auto two = random_corpus();
  ContextCorpus one;
  one.add("a", two.audio[0], two.phones[0], two.visual[0]);
  Context context;
  EXPECT_THROW(leave_one_out({}, one.audio, one.phones, one.visual, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
