#include "study/story.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/study/drawn_answers.h"
#include "tests/study/few_answers.h"

namespace talkgraph::study {
namespace {

using test::answered;
using test::person;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// With plain spaces.
std::string plain(std::string text) {
  for (std::size_t at; (at = text.find("\u00a0")) != std::string::npos;) text.replace(at, 2, " ");
  return text;
}

std::vector<std::string> sentences(const Study& study, const Answers& answers, std::size_t test) {
  std::vector<std::string> all;
  const auto chapters = story(find(study, answers));
  for (const auto& sentence : chapters.at(test).sentences) all.push_back(plain(sentence));
  return all;
}

TEST(PText, IsThatOfPapers) {
  EXPECT_EQ(plain(p_text(0.0004)), "p < 0.001");
  EXPECT_EQ(plain(p_text(0.001)), "p < 0.01");
  EXPECT_EQ(plain(p_text(0.0499)), "p < 0.05");
  EXPECT_EQ(plain(p_text(0.051)), "p > 0.05");
  EXPECT_EQ(plain(p_text(0.134)), "p > 0.13");
  EXPECT_EQ(plain(p_text(0.13)), "p > 0.12") << "it is not above 0.13";
  EXPECT_EQ(plain(p_text(1)), "p > 0.99");
  EXPECT_EQ(p_text(NAN), "–");
}

TEST(Story, TellsTheSharesOfATuringTest) {
  const Study study = test::small();
  Answers answers{{person(1, 0), person(2, 0)}, {}};
  for (const std::int64_t p : {1, 2})
    for (const char* clip : {"tr1", "tr2", "ts1", "ts2"})
      answers.answers.push_back(answered(p, "turing", clip, clip[2] == '2'));
  EXPECT_THAT(
      sentences(study, answers, 0)[0],
      "Synthetic clips were taken for real in 50 % of answers (15 to 85 %), real clips were taken for synthetic in "
      "50 % of answers (15 to 85 %).");
  EXPECT_THAT(sentences(study, answers, 0),
              Contains("Real and synthetic clips: no difference was found in one comparison "
                       "(corrected p > 0.99)."));
  EXPECT_THAT(sentences(study, answers, 1), ElementsAre("It was not answered yet."));
  const auto figures = headlines(find(study, answers));
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(plain(figures[0].figure), "50 %");
  EXPECT_EQ(figures[0].text, "of synthetic clips were taken for real");
  EXPECT_EQ(plain(figures[0].beside), "real clips: 50 %, chance: 50 %");
}

TEST(Story, NamesWhatDiffers) {
  const Study study = test::small();
  Answers answers;
  for (std::int64_t p = 1; p <= 6; ++p) {
    answers.participants.push_back(person(p, 0));
    for (const char* clip : {"or1", "or2", "os1"}) answers.answers.push_back(answered(p, "opinion", clip, 4));
    answers.answers.push_back(answered(p, "opinion", "os2", 1));
  }
  // Of C(12, 6) = 924 choices one is as extreme at either end; three comparisons.
  EXPECT_THAT(
      sentences(study, answers, 1),
      Contains("Real and synthetic clips differ in 2 of 3 comparisons: how natural of Ann, static eyes (5.00 against "
               "2.00, p < 0.01); how natural of all clips (5.00 against 3.50, p < 0.01)."));
}

TEST(Story, NamesTheOnlyComparison) {
  const Study study = test::small();
  Answers answers;
  for (std::int64_t p = 1; p <= 6; ++p) {
    answers.participants.push_back(person(p, 0));
    for (const char* clip : {"tr1", "tr2", "ts1", "ts2"})
      answers.answers.push_back(answered(p, "turing", clip, clip[1] == 's'));
  }
  EXPECT_THAT(sentences(study, answers, 0), Contains("Real and synthetic clips differ in one comparison: Ann (100 % "
                                                     "against 0 %, p < 0.01)."));
}

TEST(Story, SaysWhereThereIsTooLittle) {
  Study study = test::small();
  EXPECT_EQ(about_people(find(study, {}), {}), "Nobody has taken part yet.");
  Answers answers{{person(1, 0)}, {answered(1, "opinion", "or1", 4), answered(1, "opinion", "os1", 3)}};
  EXPECT_THAT(sentences(study, answers, 1), ElementsAre("There are too few answers to test anything."));
  EXPECT_THAT(
      about_people(find(study, answers), answers),
      "1 person took part on 1 January 1970; 0 finished. The answers of 1 person count here, 2 in all, however far "
      "each came.");
  std::erase_if(study.tests[1].clips, [](const Clip& c) { return !c.synthetic; });
  answers.answers.erase(answers.answers.begin());
  EXPECT_THAT(sentences(study, answers, 1),
              ElementsAre("All its clips are synthetic: there are no real ones to compare them with.",
                          "There are too few answers to test anything."));
  EXPECT_EQ(headlines(find(study, answers))[0].beside, "");
  answers.participants.push_back(person(2, 0, 3000));
  EXPECT_THAT(about_people(find(study, answers, {.finished_only = true}), answers),
              HasSubstr("1 finished. Only the answers of those count here: 0."));
}

}  // namespace
}  // namespace talkgraph::study
