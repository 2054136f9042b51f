#include "study/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "graph/json.h"
#include "tests/study/drawn_answers.h"
#include "tests/study/few_answers.h"
#include "tests/temporary_folder.h"

namespace talkgraph::study {
namespace {

using talkgraph::test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

struct Report : testing::Test {
  const TemporaryFolder folder;

  std::string page_of(const Study& study, const Answers& answers, const FindingOptions& options = {}) const {
    write_report(study, answers, options, folder.path());
    for (const char* name : {"report.html", "summary.csv", "summary.json", "answers.csv", "answers.json"})
      for (const char* bad : {"nan", ">-nan", "inf%", "NaN"})
        EXPECT_THAT(folder.read(name), Not(HasSubstr(bad))) << name;
    return folder.read("report.html");
  }
};

TEST_F(Report, TellsAllThereIs) {
  Random random(7);
  const Study study = test::full_study();
  const Answers answers = test::simulate(study, {.mean = test::published_mean, .give_up = 0.002}, 50, random);
  const std::string page = page_of(study, answers);
  EXPECT_LT(page.find("What was found"), page.find("<table>")) << "the story comes first";
  for (const char* part : {"50 people took part", "<h2>Replays</h2>", "<h2>Who took part</h2>", "Age and sex",
                           "Recorded eyes against static eyes", "read right, by group", "by Holm"})
    EXPECT_THAT(page, HasSubstr(part));
  for (const char* outside : {"https://", "src=", "<link", "@import", "url(", "<script"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  for (const char* plot : {"turing", "perceptual", "intelligibility", "study.replays"})
    EXPECT_THAT(folder.read(std::string("plots/") + plot + ".svg"), HasSubstr("</svg>"));

  const Json summary = Json::parse(folder.read("summary.json"));
  EXPECT_EQ(summary["correction"], "holm");
  EXPECT_EQ(summary["story"].size(), 3u);
  const Json& table = summary["tables"]["perceptual.naturalness.real-synthetic"];
  EXPECT_EQ(table["columns"][0], "real");
  EXPECT_EQ(table["rows"].size(), 5u);
  const double mean = table["rows"][0]["values"][0];
  EXPECT_THAT(
      folder.read("summary.csv"),
      HasSubstr("perceptual.naturalness.real-synthetic,\"LIPS, recorded eyes\",real," + fmt::format("{}", mean)));
}

TEST_F(Report, KeepsEveryAnswer) {
  const Study study = test::small();
  Answers answers = test::opinions();
  answers.answers.push_back(test::answered(2, "reading", "is1", 1, 3));
  page_of(study, answers, {.finished_only = true});
  const std::string csv = folder.read("answers.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 14) << "also those that do not count";
  EXPECT_THAT(csv, HasSubstr("\n2,no,reading,sentence,is1,Ann,sentence1,synthetic,,1,no,0,0,3,30,2000,yes\n"));
  EXPECT_THAT(csv, HasSubstr("\n3,yes,opinion,how_natural,or1,Ann,sentence1,real,recorded,3,4,4,0,1,10,2000,no\n"));
  const Json json = Json::parse(folder.read("answers.json"));
  EXPECT_EQ(json["answers"].size(), 13u);
  EXPECT_EQ(json["participants"][2]["finished"], 1900);
}

TEST_F(Report, IsPlainWhereThereIsLittle) {
  const Study study = test::small();
  EXPECT_THAT(page_of(study, {}), HasSubstr("Nobody has taken part yet."));
  EXPECT_THAT(page_of(study, {{test::person(1, 0)}, {}}), HasSubstr("There are no answers to tell of yet."));
  const Answers one{{test::person(1, 0)},
                    {test::answered(1, "turing", "ts1", 0), test::answered(1, "opinion", "or1", 2)}};
  EXPECT_THAT(page_of(study, one), HasSubstr("There are too few answers to test anything."));
  EXPECT_THAT(page_of(study, test::opinions()), HasSubstr("It was not answered yet."));
}

TEST_F(Report, IsWrittenOfOneKindOfClips) {
  Random random(5);
  for (const bool synthetic : {false, true}) {
    Study study = test::full_study();
    for (auto& test : study.tests) std::erase_if(test.clips, [&](const Clip& c) { return c.synthetic != synthetic; });
    const Answers answers = test::simulate(study, {.mean = test::published_mean}, 5, random);
    EXPECT_THAT(page_of(study, answers),
                HasSubstr(synthetic ? "All its clips are synthetic" : "All its clips are real"));
  }
}

TEST_F(Report, KeepsTextsFromBecomingMarkup) {
  Study study = test::small();
  const std::string evil = "<script>alert(\"&\")</script>";
  study.tests[1].title = evil;
  study.tests[1].questions[0].text = evil;
  study.profile[0].options[0] = evil;
  for (auto& test : study.tests)
    for (auto& clip : test.clips) clip.speaker = evil;
  const std::string page = page_of(study, test::opinions());
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("<h1>Ann's &lt;face&gt;</h1>"));
  EXPECT_THAT(folder.read("plots/opinion.svg"), Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace talkgraph::study
