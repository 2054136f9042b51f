#include "nodes/phones/label_frames.h"

#include <gtest/gtest.h>

#include "graph/random.h"
#include "nodes/phones/masks.h"
#include "nodes/phones/time_labels.h"
#include "nodes/phones/vote_labels.h"

namespace talkgraph {
namespace {

Track video(Eigen::Index frames, Rational rate = 25) {
  Track t;
  t.values.setZero(frames, 1);
  t.rate = rate;
  t.start = 0.5 / rate.value();
  return t;
}

using Labels = std::vector<std::string>;

TEST(LabelFrames, TakesTheMajorityOfTheFramesTime) {
  // Frames of 40 ms: [0, 40) is 30 ms "a", [40, 80) is 25 ms "b".
  const PhoneTrack phones{{{"aa", 0, 0.03}, {"b", 0.03, 0.065}, {"k", 0.065, 0.16}}};
  EXPECT_EQ(LabelFrames{}(phones, video(4)).labels, (Labels{"aa", "b", "k", "k"}));
}

TEST(LabelFrames, AddsUpTheTimesOfOneLabel) {
  const PhoneTrack phones{{{"aa", 0, 0.012}, {"b", 0.012, 0.028}, {"aa", 0.028, 0.04}}};
  EXPECT_EQ(LabelFrames{}(phones, video(1)).labels, Labels{"aa"});
}

TEST(LabelFrames, GivesTiesToTheEarlier) {
  EXPECT_EQ(LabelFrames{}({{{"b", 0, 0.02}, {"aa", 0.02, 0.04}}}, video(1)).labels, Labels{"b"});
  // The same tie in a later frame, where the times are not exact in binary.
  EXPECT_EQ(LabelFrames{}({{{"sil", 0, 0.4}, {"b", 0.4, 0.42}, {"aa", 0.42, 0.44}}}, video(11)).labels.back(), "b");
  EXPECT_EQ(LabelFrames{}({{{"sil", 0, 0.4}, {"z", 0.4, 0.42}, {"aa", 0.42, 0.44}}}, video(11)).labels.back(), "z");
}

TEST(LabelFrames, CountsUncoveredTimeAsSilence) {
  const PhoneTrack phones{{{"aa", 0.04, 0.09}}};
  EXPECT_EQ(LabelFrames{}(phones, video(4)).labels, (Labels{"sil", "aa", "sil", "sil"}));
  EXPECT_EQ(LabelFrames{}({}, video(2)).labels, (Labels{"sil", "sil"}));
  EXPECT_TRUE(LabelFrames{}(phones, video(0)).labels.empty());
}

TEST(LabelFrames, FollowsTheTracksStartAndRate) {
  Track features = video(4, 100);
  features.start = 0.0128;
  const PhoneTrack phones{{{"aa", 0, 0.0178}, {"b", 0.0178, 0.05}}};
  const FrameLabels labels = LabelFrames{}(phones, features);
  EXPECT_EQ(labels.labels, (Labels{"aa", "b", "b", "b"}));
  EXPECT_EQ(labels.rate, Rational(100));
}

TEST(VoteLabels, TakesTheMajorityOfTheWindow) {
  // Four labels of 10 ms a video frame.
  const FrameLabels at_100{{"aa", "aa", "b", "aa", "k", "k", "b", "b", "b", "k", "k", "s", "t", "t", "t"}, 100};
  const FrameLabels voted = VoteLabels{}(at_100, video(4));
  EXPECT_EQ(voted.labels, (Labels{"aa", "k", "k", "t"})) << "of equals the earlier; beyond the end is silence";
  EXPECT_EQ(voted.rate, Rational(25));
}

TEST(VoteLabels, WeighsLabelsThatReachIntoTwoFrames) {
  // Frames of 33.37 ms: the second is [33.37, 66.73): 6.63 ms "b", 10 ms "k", 10 ms "aa", 6.73 ms "b".
  const FrameLabels at_100{{"s", "s", "s", "b", "k", "aa", "b", "b", "b", "b"}, 100};
  EXPECT_EQ(VoteLabels{}(at_100, video(2, Rational(30000, 1001))).labels, (Labels{"s", "b"}));
}

TEST(VoteLabels, AgreesWithTheTimesOfPhonesThatBeginAtLabels) {
  Random random(1, "label frames", "phones");
  PhoneTrack phones;
  FrameLabels at_100{{}, 100};
  for (const char* label : {"sil", "b", "aa", "k", "s", "iy", "t", "sil", "m", "ow", "d", "z"}) {
    const auto count = 1 + random.below(9);
    const double start = static_cast<double>(at_100.labels.size()) / 100;
    at_100.labels.insert(at_100.labels.end(), count, label);
    phones.phones.push_back({label, start, static_cast<double>(at_100.labels.size()) / 100});
  }
  for (const Rational rate : {Rational(25), Rational(30), Rational(30000, 1001), Rational(60), Rational(100)}) {
    const auto frames = static_cast<Eigen::Index>(static_cast<double>(at_100.labels.size()) / 100 * rate.value()) + 1;
    EXPECT_EQ(VoteLabels{}(at_100, video(frames, rate)).labels, LabelFrames{}(phones, video(frames, rate)).labels)
        << rate.str();
  }
}

TEST(TimeLabels, MakesOnePhoneOfEachRunOfLabels) {
  const std::vector<Interval> timed = TimeLabels{}({{"sil", "b", "b", "aa", "b"}, 25}).phones;
  const std::vector<Interval> expected{{"sil", 0, 0.04}, {"b", 0.04, 0.12}, {"aa", 0.12, 0.16}, {"b", 0.16, 0.2}};
  ASSERT_EQ(timed.size(), expected.size());
  for (std::size_t n = 0; n < timed.size(); ++n) {
    EXPECT_EQ(timed[n].label, expected[n].label);
    EXPECT_DOUBLE_EQ(timed[n].start, expected[n].start);
    EXPECT_DOUBLE_EQ(timed[n].end, expected[n].end);
  }
  EXPECT_TRUE(TimeLabels{}({}).phones.empty());
}

TEST(TimeLabels, GivesTheLabelsBackAtAnyRate) {
  Random random(1, "time labels", "labels");
  for (const Rational rate : {Rational(25), Rational(30000, 1001), Rational(100)}) {
    FrameLabels labels{{}, rate};
    for (int n = 0; n < 500; ++n) labels.labels.emplace_back(1 + random.below(3), 'a');
    EXPECT_EQ(LabelFrames{}(TimeLabels{}(labels), video(500, rate)).labels, labels.labels) << rate.str();
  }
}

TEST(VoteLabels, AtItsOwnRateAndOfNothing) {
  const FrameLabels labels{{"aa", "b", "k"}, 25};
  EXPECT_EQ(VoteLabels{}(labels, video(3)).labels, labels.labels);
  EXPECT_EQ(VoteLabels{}({{}, 100}, video(2)).labels, (Labels{"sil", "sil"}));
  EXPECT_TRUE(VoteLabels{}(labels, video(0)).labels.empty());
}

using Marks = std::vector<std::int64_t>;
const PhoneTrack kSpeech{
    {{"sil", 0, 0.1}, {"aa", 0.1, 0.2}, {"sil", 0.2, 0.25}, {"breath", 0.25, 0.3}, {"b", 0.3, 0.4}}};

TEST(SpeechMask, MarksFramesWhoseCentreLiesInSpeech) {
  // Centres at 0.02, 0.06, 0.10, ... 0.42.
  EXPECT_EQ(SpeechMask{}(kSpeech, video(11)).frames, (Marks{0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 0}));
}

TEST(SpeechMask, CountsShortPausesAsSpeechIfAsked) {
  EXPECT_EQ(SpeechMask{0.11}(kSpeech, video(11)).frames, (Marks{0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(SpeechMask{0.09}(kSpeech, video(11)).frames, SpeechMask{}(kSpeech, video(11)).frames);
}

TEST(SpeechMask, TakesEmptyTracks) {
  EXPECT_EQ(SpeechMask{}({}, video(2)).frames, (Marks{0, 0}));
  EXPECT_TRUE(SpeechMask{}(kSpeech, video(0)).frames.empty());
}

TEST(WordMask, MarksFramesWhoseCentreLiesInAWord) {
  const WordTrack words{{{"sil", 0, 0.1}, {"bin", 0.1, 0.2}, {"sp", 0.2, 0.3}, {"blue", 0.3, 0.4}}};
  EXPECT_EQ(WordMask{}(words, video(11)).frames, (Marks{0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 0}));
}

}  // namespace
}  // namespace talkgraph
