#include "nodes/mapping/context_utterances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/nodes/mapping/context_corpus.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::random_corpus;
using testing::said;
using testing::track;

std::vector<ContextUtterance> utterances_of(const testing::ContextCorpus& corpus) {
  return context_utterances(corpus.audio, corpus.phones, corpus.visual);
}

TEST(ContextUtterances, HaveSoundPhonesAndFace) {
  auto corpus = random_corpus();
  corpus.audio.add("no phones", track(gaussian(4, 3, 1)));
  corpus.visual.add("no phones", track(gaussian(4, 2, 1)));
  corpus.audio.add("no face", track(gaussian(4, 3, 1)));
  corpus.phones.add("no face", said({{"b", 4}}));
  corpus.add("c", track(gaussian(5, 3, 1)), said({{"b", 6}}), track(gaussian(7, 2, 1)));
  const auto utterances = utterances_of(corpus);
  ASSERT_EQ(utterances.size(), 3u);
  EXPECT_EQ(utterances[2].key, "c");
  EXPECT_EQ(utterances[2].frames, 5);
  EXPECT_EQ(utterances[2].visual, corpus.visual.find("c"));
}

TEST(ContextUtterances, MustFitTogether) {
  const auto message_with = [](Eigen::MatrixXd audio, Eigen::MatrixXd visual) -> std::string {
    auto corpus = random_corpus();
    corpus.add("c", track(std::move(audio)), said({{"b", 4}}), track(std::move(visual)));
    try {
      utterances_of(corpus);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message_with(gaussian(4, 3, 1), gaussian(6, 2, 1)), "");
  EXPECT_EQ(message_with(gaussian(4, 3, 1), gaussian(7, 2, 1)),
            "c: 4 audio frames, 7 visual frames: bring both to one rate");
  EXPECT_EQ(message_with(gaussian(4, 2, 1), gaussian(4, 2, 1)), "c: other dimensions than the tracks before");
  EXPECT_EQ(message_with(gaussian(4, 3, 1), gaussian(4, 1, 1)), "c: other dimensions than the tracks before");
  Eigen::MatrixXd broken = gaussian(4, 3, 1);
  broken(1, 1) = NAN;
  EXPECT_EQ(message_with(broken, gaussian(4, 2, 1)), "c: NaN or infinite values");
  EXPECT_THROW(utterances_of({}), std::runtime_error);
}

TEST(ContextUtterances, KnowWhatIsNearSpeech) {
  const Track ten = track(Eigen::MatrixXd::Zero(10, 1));
  const PhoneTrack phones = said({{"sil", 4}, {"b", 2}, {"sil", 4}});
  const ContextUtterance utterance{"a", &ten, &phones, &ten, 9};
  EXPECT_THAT(near_speech(utterance, 0), ::testing::ElementsAre(0, 0, 0, 0, 1, 1, 0, 0, 0));
  EXPECT_THAT(near_speech(utterance, 2), ::testing::ElementsAre(0, 0, 1, 1, 1, 1, 1, 1, 0));
}

}  // namespace
}  // namespace talkgraph
