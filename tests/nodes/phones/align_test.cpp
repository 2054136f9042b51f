#include "nodes/phones/align.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <thread>

#include "nodes/evaluate/alignment.h"
#include "nodes/phones/recognise.h"
#include "nodes/voice/voice.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::optional<Alignment> align(const Audio& audio, const Transcript* transcript, const WordTrack* words,
                               const PhoneTrack* given) {
  Context context;
  return Align{}(audio, transcript, words, given, context);
}

PhoneTrack align(const Audio& audio, const std::string& text) {
  const Transcript transcript{text};
  return align(audio, &transcript, nullptr, nullptr).value().phones;
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

class SpokenSentence : public testing::Test {
 protected:
  const std::string text = "Please bring me six big blue cups.";
  const Utterance sentence = speak(text, {});
};

/// Figures of nodes/evaluate/alignment.h.
std::map<std::string, double> figures(const Collected<PhoneTrack>& truth, const Collected<PhoneTrack>& found) {
  const Table table = ScoreAlignment{}(truth, found).table;
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < table.columns.size(); ++i) values[table.columns[i]] = table.cells[0][i];
  return values;
}

const std::vector<std::string> kTexts = {"The old sailor painted his boat bright blue last weekend.",
                                         "Can you lend me seven dollars until Friday morning?",
                                         "Heavy rain fell on the quiet village through the night.",
                                         "My brother plays the violin better than anyone I know.",
                                         "A small bird built its nest under our kitchen window.",
                                         "Please turn off the light before you leave the office.",
                                         "Fresh bread and strong coffee make a good breakfast.",
                                         "We should have taken the second road on the left.",
                                         "Their youngest daughter wants to be a famous dancer.",
                                         "He measured the garage and found it far too narrow.",
                                         "Her answer came quickly, but it was hardly a surprise.",
                                         "The museum shows paintings of the nineteenth century."};

TEST(Align, FindsThePhonesOfSpeechWhosePhonesAreKnown) {
  Collected<PhoneTrack> truth, found;
  for (std::size_t i = 0; i < kTexts.size(); ++i) {
    Voice voice;
    voice.name = i % 2 ? "en-us" : "en-us+michel";
    voice.rate = 140 + 10 * static_cast<double>(i % 6);
    const Utterance said = speak(kTexts[i], voice);
    const PhoneTrack phones = align(said.audio, kTexts[i]);
    expect_covers(phones, said.audio.seconds());
    truth.add(kTexts[i], said.phones);
    found.add(kTexts[i], phones);
  }
  auto value = figures(truth, found);
  EXPECT_LT(value["median"], 5);
  EXPECT_LT(std::abs(value["bias"]), 2);
  EXPECT_GT(value["within 20 ms"], 0.83);
  EXPECT_GT(value["within 50 ms"], 0.93);
  EXPECT_LT(value["different"], 0.07);
}

TEST_F(SpokenSentence, HasItsWordsBetweenItsPhones) {
  const Transcript transcript{text};
  const Alignment found = align(sentence.audio, &transcript, nullptr, nullptr).value();
  expect_covers({found.words.words}, sentence.audio.seconds());
  std::vector<std::string> words;
  for (const auto& word : found.words.words) {
    if (word.label != "sil") words.push_back(word.label);
    EXPECT_TRUE(std::any_of(found.phones.phones.begin(), found.phones.phones.end(), [&](const Interval& phone) {
      return phone.start == word.start;
    })) << word.label;
  }
  EXPECT_EQ(words, (std::vector<std::string>{"please", "bring", "me", "six", "big", "blue", "cups"}));
}

/// Sentences one after the other with pauses between them, some of them long.
struct Reading {
  std::string text;
  Audio audio{{}, 22050};
  PhoneTrack phones;

  void add(const std::string& sentence, double pause) {
    const Utterance said = speak(sentence, {});
    text += sentence + " ";
    for (const auto& phone : said.phones.phones)
      phones.phones.push_back({phone.label, phone.start + audio.seconds(), phone.end + audio.seconds()});
    const auto before = audio.samples.size(), length = said.audio.samples.size();
    audio.samples.conservativeResize(before + length + std::llround(pause * audio.rate));
    audio.samples.segment(before, length) = said.audio.samples;
    audio.samples.tail(audio.samples.size() - before - length).setZero();
    phones.phones.push_back({"sil", phones.phones.back().end, audio.seconds()});
  }
};

TEST(Align, TakesLongRecordings) {
  Reading reading;
  for (int round = 0; round < 3; ++round)
    for (std::size_t i = 0; i < kTexts.size(); ++i) reading.add(kTexts[i], round == 2 && i == 3 ? 250 : 0.4);
  ASSERT_GT(reading.audio.seconds(), 328) << "PocketSphinx counts frames in 16 bits";
  const PhoneTrack phones = align(reading.audio, reading.text);
  expect_covers(phones, reading.audio.seconds());
  auto value = figures({{"all", reading.phones}}, {{"all", phones}});
  EXPECT_LT(value["median"], 5);
  EXPECT_GT(value["within 20 ms"], 0.8);
  EXPECT_LT(value["different"], 0.07);
}

TEST(Align, SaysWhereALongRecordingLeavesItsTranscript) {
  Reading reading, other;
  for (std::size_t i = 0; i < 30; ++i) {
    const bool differs = i >= 20 && i < 24;
    reading.add(kTexts[i % kTexts.size()], 0.4);
    other.text +=
        (differs ? "Thirty thousand men watch football every Thursday afternoon" : kTexts[i % kTexts.size()]) + ". ";
  }
  const std::string error = error_of(reading.audio, other.text);
  ASSERT_THAT(error, HasSubstr("unlike what is said there"));
  const double at = std::stod(error.substr(error.find("from ") + 5));
  EXPECT_NEAR(at, 20.0 / 30 * reading.audio.seconds(), 6);
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
  const PhoneTrack from_words = align(sentence.audio, nullptr, &sentence.words, nullptr).value().phones;
  expect_same(from_words, align(sentence.audio, text));
}

TEST_F(SpokenSentence, PassesGivenPhonesOn) {
  const Transcript transcript{"something else"};
  expect_same(align(sentence.audio, &transcript, nullptr, &sentence.phones).value().phones, sentence.phones);
}

TEST_F(SpokenSentence, WithoutWordsIsLeftToRecognition) {
  EXPECT_FALSE(align(sentence.audio, nullptr, nullptr, nullptr));
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

TEST_F(SpokenSentence, OfOtherWordsAfterAPauseIsRefused) {
  Audio later = sentence.audio;
  later.samples.resize(sentence.audio.samples.size() + 22050);
  later.samples << Eigen::VectorXd::Zero(22050), sentence.audio.samples;
  EXPECT_THAT(error_of(later, text), HasSubstr("no error"));
  EXPECT_THAT(error_of(later, "thirty thousand men watch football"), HasSubstr("does not match"));
  EXPECT_THAT(error_of(later, "please bring me six big blue cups and then go home quickly"), HasSubstr("do not fit"));
}

double number_after(const std::string& text, const std::string& words) {
  return std::stod(text.substr(text.find(words) + words.size()));
}

TEST_F(SpokenSentence, WithMoreThanTheTranscriptHasIsRefusedWithThePlace) {
  const auto starts_at = [&](const std::string& label) {
    for (const auto& word : sentence.words.words)
      if (word.label == label) return word.start;
    throw std::logic_error(label);
  };
  const struct {
    std::string text;
    double start, end;
  } cases[] = {{"please bring me", starts_at("six"), sentence.audio.seconds()},
               {"big blue cups", 0, starts_at("big")},
               {"please bring cups", starts_at("me"), starts_at("cups")}};
  for (const auto& c : cases) {
    const std::string error = error_of(sentence.audio, c.text);
    ASSERT_THAT(error, HasSubstr("is not in the transcript; complete the transcript")) << c.text;
    EXPECT_NEAR(number_after(error, "said from "), c.start, 0.15) << error;
    EXPECT_NEAR(number_after(error, "s to "), c.end, 0.15) << error;
  }
}

TEST_F(SpokenSentence, WithALittleMoreThanTheTranscriptHasIsTold) {
  const Transcript transcript{"please bring me six big blue"};
  Context context;
  std::string said;
  context.on_warning = [&](std::string_view message) { said += message; };
  Align align;
  align.unwritten = 0.6;
  const auto aligned = align(sentence.audio, &transcript, nullptr, nullptr, context);
  ASSERT_TRUE(aligned);
  EXPECT_EQ(aligned->phones.phones.back().label, "sil");
  ASSERT_THAT(said, HasSubstr("is not in the transcript: it counts as a pause"));
  EXPECT_NEAR(number_after(said, "said from "), sentence.words.words.end()[-2].start, 0.1) << said;
}

TEST(Align, TellsNothingOfPausesInRightTranscripts) {
  for (const auto& text : kTexts) {
    Context context;
    context.on_warning = [&](std::string_view message) { ADD_FAILURE() << text << message; };
    const Transcript transcript{text};
    EXPECT_TRUE(Align{}(speak(text, {}).audio, &transcript, nullptr, nullptr, context));
  }
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

TEST(Align, SpellsNumbersOut) {
  const Transcript transcript{"They read 25 pages on the 3rd of May 1984."};
  const Alignment found = align(speak(transcript.text, {}).audio, &transcript, nullptr, nullptr).value();
  std::string words;
  for (const auto& word : found.words.words)
    if (word.label != "sil") words += word.label + " ";
  EXPECT_EQ(words, "they read twenty five pages on the third of may nineteen eighty four ");
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
