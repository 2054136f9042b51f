#include "nodes/phones/mark_pauses.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

using Labels = std::vector<std::string>;

Labels marked(const Labels& labels, double wait) { return MarkPauses{wait}({labels, Rational(25)}).labels; }

const Labels spoken = {"sil", "sil", "ae", "sil", "sil", "sil", "t", "sil", "sil", "sil", "sil"};

TEST(MarkPausesAsHeard, CallsAPauseTrailingOnceItHasLasted) {
  EXPECT_EQ(marked(spoken, 0.08), (Labels{"lead_sil", "lead_sil", "ae", "sil", "sil", "trail_sil", "t", "sil", "sil",
                                          "trail_sil", "trail_sil"}));
  EXPECT_EQ(marked(spoken, 0.12)[5], "sil");
  EXPECT_EQ(marked(spoken, 0.12)[10], "trail_sil");
}

TEST(MarkPausesAsHeard, KnowsNoLaterLabel) {
  for (std::size_t t = 0; t < spoken.size(); ++t) {
    Labels beginning(spoken.begin(), spoken.begin() + static_cast<std::ptrdiff_t>(t) + 1);
    EXPECT_EQ(marked(beginning, 0.08).back(), marked(spoken, 0.08)[t]);
    beginning.insert(beginning.end(), {"b", "b"});
    EXPECT_EQ(marked(beginning, 0.08)[t], marked(spoken, 0.08)[t]);
  }
}

TEST(MarkPauses, OfAWholeUtteranceLeavesPausesWithin) {
  EXPECT_EQ(marked(spoken, 0), (Labels{"lead_sil", "lead_sil", "ae", "sil", "sil", "sil", "t", "trail_sil", "trail_sil",
                                       "trail_sil", "trail_sil"}));
  EXPECT_EQ(marked({"sil", "breath"}, 0.08), (Labels{"lead_sil", "lead_breath"}));
  EXPECT_TRUE(marked({}, 0.08).empty());
}

}  // namespace
}  // namespace talkgraph
