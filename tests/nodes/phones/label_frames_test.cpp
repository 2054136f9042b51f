#include "nodes/phones/label_frames.h"

#include <gtest/gtest.h>

#include "nodes/phones/masks.h"

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
