#include "nodes/phones/align.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "nodes/phones/recognise.h"
#include "nodes/voice/voice.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::HasSubstr;

PhoneTrack align(const Audio& audio, const std::string& text) {
  const Transcript transcript{text};
  return Align{}(audio, &transcript, nullptr, nullptr).value().phones;
}

void expect_covers(const PhoneTrack& track, double seconds) {
  ASSERT_FALSE(track.phones.empty());
  EXPECT_EQ(track.phones.front().start, 0);
  EXPECT_EQ(track.phones.back().end, seconds);
  for (std::size_t i = 0; i < track.phones.size(); ++i) {
    EXPECT_LT(track.phones[i].start, track.phones[i].end);
    if (i > 0) {
      EXPECT_EQ(track.phones[i].start, track.phones[i - 1].end);
    }
  }
}

void expect_same(const PhoneTrack& a, const PhoneTrack& b) {
  ASSERT_EQ(a.phones.size(), b.phones.size());
  for (std::size_t i = 0; i < a.phones.size(); ++i) {
    EXPECT_EQ(a.phones[i].label, b.phones[i].label);
    EXPECT_EQ(a.phones[i].start, b.phones[i].start);
    EXPECT_EQ(a.phones[i].end, b.phones[i].end);
  }
}

std::string error_of(const Audio& audio, const std::string& text) {
  try {
    align(audio, text);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "no error";
}

#ifdef TALKGRAPH_ESPEAK

std::vector<std::string> spoken(const PhoneTrack& track) {
  std::vector<std::string> labels;
  for (const auto& phone : track.phones)
    if (phone.label != "sil") labels.push_back(phone.label);
  return labels;
}

std::vector<double> starts(const PhoneTrack& track) {
  std::vector<double> times;
  for (const auto& phone : track.phones)
    if (phone.label != "sil") times.push_back(phone.start);
  return times;
}

class SpokenSentence : public testing::Test {
 protected:
  const std::string text = "Please bring me six big blue cups.";
  const Utterance sentence = speak(text, {});
};

TEST_F(SpokenSentence, IsAlignedToWithin15Milliseconds) {
  const PhoneTrack phones = align(sentence.audio, text);
  expect_covers(phones, sentence.audio.seconds());
  ASSERT_EQ(spoken(phones), spoken(sentence.phones));
  const auto found = starts(phones), truth = starts(sentence.phones);
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) errors.push_back(std::abs(found[i] - truth[i]));
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.015);
}

TEST_F(SpokenSentence, DoesNotDependOnWhatCameBeforeOrOnThreads) {
  const std::string other = "The juice of lemons makes fine punch.";
  const Audio other_audio = speak(other, {}).audio;
  const PhoneTrack first = align(sentence.audio, text);
  const PhoneTrack second = align(other_audio, other);
  expect_same(align(sentence.audio, text), first);
  PhoneTrack beside_a, beside_b;
  std::thread a([&] { beside_a = align(sentence.audio, text); });
  std::thread b([&] { beside_b = align(other_audio, other); });
  a.join();
  b.join();
  expect_same(beside_a, first);
  expect_same(beside_b, second);
}

TEST_F(SpokenSentence, TakesWordsInsteadOfATranscript) {
  const PhoneTrack from_words = Align{}(sentence.audio, nullptr, &sentence.words, nullptr).value().phones;
  expect_same(from_words, align(sentence.audio, text));
}

TEST_F(SpokenSentence, PassesGivenPhonesOn) {
  const Transcript transcript{"something else"};
  expect_same(Align{}(sentence.audio, &transcript, nullptr, &sentence.phones).value().phones, sentence.phones);
}

TEST_F(SpokenSentence, WithoutWordsIsLeftToRecognition) {
  EXPECT_FALSE(Align{}(sentence.audio, nullptr, nullptr, nullptr));
  Context context;
  std::string said;
  context.on_warning = [&](std::string_view message) { said = message; };
  const PhoneTrack phones = Recognise{}(sentence.audio, nullptr, context);
  expect_covers(phones, sentence.audio.seconds());
  EXPECT_GT(phones.phones.size(), 10u);
  EXPECT_THAT(said, HasSubstr("wrong"));
  expect_same(Recognise{}(sentence.audio, nullptr, context), phones);
  expect_same(Recognise{}(sentence.audio, &sentence.phones, context), sentence.phones);
}

TEST_F(SpokenSentence, OfOtherWordsIsRefusedWithThePlace) {
  EXPECT_THAT(error_of(sentence.audio, "thirty thousand men watch football"),
              AllOf(HasSubstr("does not match"), HasSubstr("thirty thousand"), HasSubstr(" s to ")));
}

TEST_F(SpokenSentence, TooShortForTheWordsIsRefusedWithThePlace) {
  std::string long_text;
  for (int i = 0; i < 20; ++i) long_text += text + " ";
  EXPECT_THAT(error_of(sentence.audio, long_text), AllOf(HasSubstr("140 words"), HasSubstr("do not fit")));
}

TEST(Align, PronouncesWordsOutsideTheDictionary) {
  const std::string text = "The zorgblat found 25 cups.";
  const Utterance sentence = speak(text, {});
  EXPECT_EQ(spoken(align(sentence.audio, text)), spoken(sentence.phones));
}

#endif

TEST(Align, RefusesWordsThatNobodySays) {
  Audio silence;
  silence.samples.setZero(16000);
  EXPECT_THAT(error_of(silence, "hello there"),
              HasSubstr("there is no sound for \"hello there\": the recording, 1.00 s"));
  for (const Audio& audio :
       {silence, Audio{Eigen::VectorXd::Ones(1), 44100}, Audio{Eigen::VectorXd::Ones(300), 8000}, Audio{}})
    EXPECT_THAT(error_of(audio, "hello"), HasSubstr("is silent"));
}

TEST(Recognise, CallsSilenceSilence) {
  Audio silence;
  silence.samples.setZero(16000);
  for (const Audio& audio :
       {silence, Audio{Eigen::VectorXd::Ones(1), 44100}, Audio{Eigen::VectorXd::Ones(300), 8000}}) {
    Context context;
    const auto phones = Recognise{}(audio, nullptr, context);
    ASSERT_EQ(phones.phones.size(), 1u);
    EXPECT_EQ(phones.phones[0].label, "sil");
    expect_covers(phones, audio.seconds());
  }
}

TEST(Align, RefusesATranscriptWithoutWords) {
  const Audio audio{Eigen::VectorXd::Random(16000), 16000};
  EXPECT_THAT(error_of(audio, " ... "), HasSubstr("the transcript holds no word; leave it out"));
}

}  // namespace
}  // namespace talkgraph
