#include "nodes/mapping/context_training.h"

#include <gtest/gtest.h>

#include "tests/nodes/mapping/context_corpus.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::said;
using testing::track;

using Rows = std::vector<Eigen::Index>;

TEST(ContextTraining, PausesAreThinnedAndLostFramesLeftOut) {
  testing::ContextCorpus corpus;
  auto visual = track(gaussian(20, 2, 7));
  visual.lost = {1};
  corpus.add("a", track(gaussian(20, 3, 8)), said({{"b", 4}, {"sil", 16}}), visual);
  const auto learn = [&](const TrainContextGp& node) {
    return context_training(node, corpus.audio, corpus.phones, corpus.visual);
  };
  const auto training = learn({.margin = 2, .pauses = 5});
  EXPECT_EQ(training.rows, (Rows{0, 2, 3, 4, 5, 10, 15}));
  const Eigen::MatrixXd learnt = visual.values(training.rows, Eigen::all);
  EXPECT_LT((training.targets.rowwise() + training.model.mean - learnt).norm(), 1e-12);
  EXPECT_LT(training.targets.colwise().sum().norm(), 1e-12);
  EXPECT_EQ(training.model.frames.rows(), 20);
  EXPECT_EQ(learn({.margin = 2, .pauses = 1, .max_frames = 5}).rows.size(), 5u);
}

TEST(ContextTraining, ThinsAtEvenDistances) {
  EXPECT_EQ(thinned({1, 2, 4, 8}, 4), (Rows{1, 2, 4, 8}));
  EXPECT_EQ(thinned({1, 2, 4, 8, 16, 32}, 3), (Rows{1, 4, 16}));
  EXPECT_EQ(thinned({1, 2, 4, 8, 16}, 2), (Rows{1, 4}));
  EXPECT_EQ(thinned({}, 2), Rows{});
}

}  // namespace
}  // namespace talkgraph
