#include "nodes/context/segment_online.h"

#include <gtest/gtest.h>

#include "graph/random.h"
#include "nodes/context/automaton.h"
#include "nodes/context/decode.h"
#include "nodes/context/train.h"

namespace talkgraph {
namespace {

FrameLabels letters(const std::string& text) {
  FrameLabels f;
  for (const char c : text) f.labels.emplace_back(1, c);
  return f;
}

std::string random_letters(Random& random, int n) {
  std::string s;
  char at = 'a';
  for (int i = 0; i < n; ++i) {
    if (random.uniform() < 0.4) at = static_cast<char>('a' + random.below(5));
    s += at;
  }
  return s;
}

Vlmm contexts_of_abc() {
  Vlmm v;
  for (const char* label : {"a", "b", "c", "a-b", "a-b-c", "lead_sil"}) v.windows[label] = 10;
  return v;
}

std::string str(const SegmentTrack& track) {
  std::string s;
  for (const auto& segment : track.segments)
    s += segment.label + "@" + std::to_string(segment.start) + "+" + std::to_string(segment.length) + " ";
  return s;
}

const FrameLabels contexts{{"a", "a-b", "a-b-c", "a", "a-b"}, Rational(25)};

// Frames of 40 ms. a, a-b and a-b-c grow; a after them cannot, which is known one frame later.
TEST(ContextSegmentOnline, CutsWhereALabelCannotGrow) {
  const auto out = ContextSegmentOnline{.lookahead = 400}(contexts_of_abc(), contexts);
  EXPECT_EQ(str(out.segments), "a-b-c@0+3 a-b@3+2 ");
  // Waits of 3, 2, 1 and, the end being known, 1, 0 frames.
  EXPECT_NEAR(out.latency.values.at("latency"), 40 * 7.0 / 5, 1e-12);
  EXPECT_EQ(out.latency.values.at("latency_most"), 120);
}

TEST(ContextSegmentOnline, CutsAtTheLookAhead) {
  const auto out = ContextSegmentOnline{.lookahead = 79}(contexts_of_abc(), contexts);  // one whole frame ahead
  EXPECT_EQ(str(out.segments), "a-b@0+2 c@2+1 a-b@3+2 ");
  EXPECT_NEAR(out.latency.values.at("latency"), 40 * (1 + 0 + 1 + 1 + 0) / 5.0, 1e-12);
  const auto at_once = ContextSegmentOnline{.lookahead = 0}(contexts_of_abc(), contexts);
  EXPECT_EQ(str(at_once.segments), "a@0+1 b@1+1 c@2+1 a@3+1 b@4+1 ");
  EXPECT_EQ(at_once.latency.values.at("latency_most"), 0);
}

TEST(ContextSegmentOnline, CutsPausesRunsAndUtterancesAtTheLookAheadOnly) {
  const FrameLabels paused{{"lead_sil", "lead_sil", "lead_sil", "a", "a", "b"}, Rational(25)};
  Vlmm v = contexts_of_abc();
  EXPECT_EQ(str(ContextSegmentOnline{.lookahead = 40}(v, paused).segments),
            "lead_sil@0+2 lead_sil@2+1 a@3+1 a@4+1 b@5+1 ");
  EXPECT_EQ(str(ContextSegmentOnline{StateKind::phones, 80}(v, paused).segments), "lead_sil@0+3 a@3+2 b@5+1 ");
  EXPECT_EQ(str(ContextSegmentOnline{StateKind::one, 120}(v, paused).segments), "utterance@0+4 utterance@4+2 ");
  v.repeating = false;
  const FrameLabels runs{{"a", "a", "a-b", "a-b", "a-b", "a"}, Rational(25)};
  EXPECT_EQ(str(ContextSegmentOnline{.lookahead = 400}(v, runs).segments), "a-b@0+5 a@5+1 ");
  EXPECT_EQ(str(ContextSegmentOnline{.lookahead = 120}(v, runs).segments), "a-b@0+4 b@4+1 a@5+1 ");
}

TEST(ContextSegmentOnline, OfNoFramesIsNone) {
  const auto out = ContextSegmentOnline{}(contexts_of_abc(), FrameLabels{});
  EXPECT_TRUE(out.segments.segments.empty());
  EXPECT_EQ(out.latency.values.at("latency"), 0);
}

class OnRandomStreams : public ::testing::TestWithParam<double> {
 protected:
  OnRandomStreams() {
    Collected<FrameLabels> train;
    for (int i = 0; i < 6; ++i) train.add(std::to_string(i), letters(random_letters(random_, 80)));
    vlmm_ = ContextTrain{.order = 4, .prune = 0, .keep = 1e-4, .min_windows = 3}(train);
  }
  std::vector<Segment> segments(const std::string& text) const {
    return ContextSegmentOnline{.lookahead = GetParam()}(vlmm_, ContextDecode{}(vlmm_, letters(text)))
        .segments.segments;
  }
  Random random_{11};
  Vlmm vlmm_;
};
INSTANTIATE_TEST_SUITE_P(LookAheads, OnRandomStreams, ::testing::Values(0, 40, 120, 200));

TEST_P(OnRandomStreams, CoversEveryFrameOnceWithItsPhones) {
  for (int i = 0; i < 20; ++i) {
    const std::string text = random_letters(random_, 1 + 4 * i);
    std::int64_t at = 0;
    for (const auto& s : segments(text)) {
      EXPECT_EQ(s.start, at);
      EXPECT_LE(s.length, 1 + static_cast<std::int64_t>(GetParam() / 40));
      EXPECT_EQ(s.label, join_phones(letters(text.substr(static_cast<std::size_t>(at))).labels, 0,
                                     static_cast<std::size_t>(s.length)));
      at += s.length;
    }
    EXPECT_EQ(at, std::ssize(text));
  }
}

TEST_P(OnRandomStreams, DoesNotKnowTheFuture) {
  const auto ahead = static_cast<std::size_t>(GetParam() / 40);
  for (int i = 0; i < 50; ++i) {
    const std::string text = random_letters(random_, 40);
    const auto t = static_cast<std::size_t>(random_.below(35));
    const std::string other = text.substr(0, t + ahead + 1) + random_letters(random_, 1 + i % 7);
    const auto a = segments(text), b = segments(other);
    for (std::size_t k = 0; k < a.size() && a[k].start <= static_cast<std::int64_t>(t); ++k) {
      EXPECT_EQ(a[k].label, b.at(k).label) << text << " " << other << " " << t;
      EXPECT_EQ(a[k].start, b[k].start);
      EXPECT_EQ(a[k].length, b[k].length);
    }
  }
}

}  // namespace
}  // namespace talkgraph
