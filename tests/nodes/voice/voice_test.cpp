#include "nodes/voice/voice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/voice/recordings.h"
#include "nodes/voice/speak.h"
#include "nodes/voice/words.h"

namespace talkgraph {
namespace {

using Phones = std::vector<std::string>;

#ifdef TALKGRAPH_ESPEAK

std::vector<std::string> labels(const std::vector<Interval>& intervals) {
  std::vector<std::string> all;
  for (const auto& i : intervals) all.push_back(i.label);
  return all;
}

void expect_covered(const std::vector<Interval>& intervals, double seconds) {
  ASSERT_FALSE(intervals.empty());
  EXPECT_DOUBLE_EQ(intervals.back().end, seconds);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    EXPECT_GT(intervals[i].end, intervals[i].start) << intervals[i].label;
    EXPECT_EQ(intervals[i].start, i == 0 ? 0 : intervals[i - 1].end) << intervals[i].label;
  }
}

TEST(Voice, PhonesAndWordsCoverTheSoundWithoutGaps) {
  for (const auto* text : {"She had your dark suit in greasy wash water all year.", "Here and there, poor fires; why?",
                           "Of the 25 boys, 3 were out of the house."}) {
    const auto u = speak(text, {});
    expect_covered(u.phones.phones, u.audio.seconds());
    expect_covered(u.words.words, u.audio.seconds());
  }
}

TEST(Voice, KnownWordsHaveTheirCmuPhones) {
  EXPECT_EQ(pronounce("cat"), (Phones{"k", "ae", "t"}));
  EXPECT_EQ(pronounce("church"), (Phones{"ch", "er", "ch"}));
  EXPECT_EQ(pronounce("beer"), (Phones{"b", "ih", "r"}));
  EXPECT_EQ(pronounce("measure"), (Phones{"m", "eh", "zh", "er"}));
  EXPECT_EQ(pronounce("boy"), (Phones{"b", "oy"}));
  EXPECT_EQ(pronounce("yellow"), (Phones{"y", "eh", "l", "ow"}));
  EXPECT_EQ(pronounce("thinking"), (Phones{"th", "ih", "ng", "k", "ih", "ng"}));
  EXPECT_EQ(pronounce("-"), Phones{});
}

TEST(Voice, RColouredVowelIsTwoPhones) {
  const auto u = speak("Four cars.", {});
  EXPECT_EQ(labels(u.phones.phones), (Phones{"sil", "f", "ao", "r", "k", "aa", "r", "z", "sil"}));
}

TEST(Voice, WordsKeepTheirPlaceWhereEspeakRunsThemTogetherOrReadsSeveral) {
  const auto u = speak("Of the 25 boys, one was out of the house.", {});
  Phones words;
  for (const auto& w : u.words.words)
    if (w.label != "sil") words.push_back(w.label);
  EXPECT_EQ(words, (Phones{"of", "the", "25", "boys", "one", "was", "out", "of", "the", "house"}));
}

TEST(Voice, TheSameCallGivesTheSameSoundWhateverWasSaidBefore) {
  const auto first = speak("Show the blue moon to them.", {});
  Voice fast;
  fast.rate = 250;
  speak("Something else, quite quickly.", fast);
  const auto second = speak("Show the blue moon to them.", {});
  ASSERT_EQ(first.audio.samples.size(), second.audio.samples.size());
  EXPECT_LE((first.audio.samples - second.audio.samples).cwiseAbs().maxCoeff(), 1.0 / 32768);
}

TEST(Voice, TheClosureBelongsToTheStop) {
  const auto u = speak("A copper cup.", {});
  const auto& phones = u.phones.phones;
  for (std::size_t i = 1; i + 1 < phones.size(); ++i) {
    if (phones[i].label != "p" || phones[i - 1].label == "sil") continue;
    EXPECT_GT(phones[i].end - phones[i].start, 0.06);
    const auto at = static_cast<Eigen::Index>((phones[i].start + 0.01) * u.audio.rate);
    EXPECT_LT(std::abs(u.audio.samples[at]), 0.01);
  }
}

TEST(Voice, RateChangesTheLengthAndVolumeTheSound) {
  Voice fast, quiet;
  fast.rate = 220;
  quiet.volume = 40;
  const auto text = "Many happy people walk to the sea.";
  const auto plain = speak(text, {});
  EXPECT_LT(speak(text, fast).audio.seconds(), 0.9 * plain.audio.seconds());
  EXPECT_LT(speak(text, quiet).audio.samples.norm(), 0.7 * plain.audio.samples.norm());
}

TEST(Voice, ImpossibleVoicesAndEmptyTextsAreRefused) {
  Voice unknown, hasty, mute;
  unknown.name = "no-such-voice";
  hasty.rate = 1000;
  mute.volume = std::nan("");
  EXPECT_THROW(speak("Hello.", unknown), std::invalid_argument);
  EXPECT_THROW(speak("Hello.", hasty), std::invalid_argument);
  EXPECT_THROW(speak("Hello.", mute), std::invalid_argument);
  EXPECT_THROW(speak("", {}), std::invalid_argument);
  EXPECT_THROW(speak(" ... ", {}), std::invalid_argument);
}

TEST(Voice, RecordingsHaveAllButPictures) {
  SpokenRecordings node;
  node.texts = {"Good morning.", "How are you?"};
  auto stream = node();
  EXPECT_EQ(stream.size(), 2u);
  const auto first = stream.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->key, "text-1");
  EXPECT_EQ(first->value.id, "text-1");
  EXPECT_FALSE(first->value.video);
  EXPECT_EQ(first->value.audio().seconds(), first->value.phones->phones.back().end);
  EXPECT_EQ(first->value.transcript->text, "Good morning.");
  EXPECT_TRUE(stream.next());
  EXPECT_FALSE(stream.next());
  node.texts.clear();
  EXPECT_THROW(node(), std::invalid_argument);
}

#else

TEST(Voice, SaysThatItWasSwitchedOff) {
  EXPECT_THROW(speak("Hello.", {}), std::runtime_error);
  EXPECT_THROW(pronounce("hello"), std::runtime_error);
}

#endif

TEST(Voice, UnknownPhonemeIsAnError) {
  EXPECT_EQ(cmu_phones("_:"), Phones{});
  EXPECT_EQ(cmu_phones("aI3"), (Phones{"ay", "er"}));
  EXPECT_THROW(cmu_phones("q!"), std::runtime_error);
}

TEST(Voice, WordsAreSplitFromPunctuation) {
  EXPECT_EQ(split_words("\"Don't,\" she said - twice!"), (Phones{"don't", "she", "said", "twice"}));
  EXPECT_TRUE(split_words(" ?! ").empty());
}

}  // namespace
}  // namespace talkgraph
