#include "nodes/context/inspect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/context/train.h"

namespace talkgraph {
namespace {

// Of "aabaabaabaab" (context_test says how): memories none, a, aa, b, ba; labels a, a-a, a-a-b, b-a, b-a-a.
TEST(InspectContexts, ListsWhatTheModelHolds) {
  FrameLabels labels;
  for (const char c : std::string("aabaabaabaab")) labels.labels.emplace_back(1, c);
  const ContextTrain train{.order = 2, .prune = 0, .keep = 0.01, .min_windows = 4};
  const auto out = InspectContexts{.thin = 3}(train({{"x", labels}}));

  EXPECT_EQ(out.memories.rows, (std::vector<std::string>{"none", "a", "a-a", "b", "b-a"}));
  EXPECT_EQ(out.memories.cells[1], (std::vector<double>{1, 1, 1, 2, 1}));  // number, length, frames, followers, bits
  EXPECT_EQ(out.memories.cells[2], (std::vector<double>{2, 2, 4, 1, 0}));
  EXPECT_EQ(out.memories.cells[0][2], 1);
  EXPECT_NEAR(out.memories.cells[0][4], std::log2(3) - 2. / 3, 1e-12);

  ASSERT_EQ(out.labels.rows, (std::vector<std::string>{"a-a-b", "b-a", "b-a-a", "a", "a-a", "b"}));
  EXPECT_EQ(out.labels.cells[0], (std::vector<double>{3, 4, 1. / 3, 4}));
  EXPECT_TRUE(std::isnan(out.labels.cells[1][3]));
  EXPECT_EQ(out.labels.cells[5], (std::vector<double>{1, 0, 0, 4}));

  EXPECT_EQ(out.transitions.rows, (std::vector<std::string>{"a", "b", "a-a", "a-b", "a-a-b", "b-a", "b-a-a"}));
  EXPECT_EQ(out.transitions.cells[3], (std::vector<double>{1, 3, 0.5, 0}));
  EXPECT_EQ(out.transitions.cells[6], (std::vector<double>{4, 2, 1, 3}));

  // Five labels carry 4, 3, 3, 1 and 1 frames.
  EXPECT_EQ(out.summary.cells[0], (std::vector<double>{5, 7, 5, 4, 4, 8. / 12, 3}));
}

TEST(InspectContexts, SeesALonelyFrame) {
  const auto out = InspectContexts{}(ContextTrain{}({{"x", {{"a"}, Rational(25)}}}));
  EXPECT_EQ(out.labels.rows, std::vector<std::string>{"a"});
  EXPECT_EQ(out.summary.cells[0], (std::vector<double>{1, 1, 1, 1, 1, 1, 1}));
}

}  // namespace
}  // namespace talkgraph
