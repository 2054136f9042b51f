#include "study/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "nodes/statistics/intervals.h"
#include "nodes/statistics/proportions.h"
#include "study/tables.h"
#include "tests/study/few_answers.h"

namespace talkgraph::study {
namespace {

using test::answered;
using test::person;
using testing::HasSubstr;
using Kind = Comparison::Kind;

std::string refusal(const Answers& answers) {
  try {
    find(test::small(), answers);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

const Comparison& comparison(const Findings& findings, const std::string& test, Kind kind, const std::string& of) {
  const auto is_it = [&](const Comparison& c) {
    return findings.measures[c.measure].test->id == test && c.kind == kind && c.of == of;
  };
  return *std::find_if(findings.comparisons.begin(), findings.comparisons.end(), is_it);
}

double cell(const Table& t, const std::string& row, const std::string& column) {
  const auto r = std::find(t.rows.begin(), t.rows.end(), row) - t.rows.begin();
  const auto c = std::find(t.columns.begin(), t.columns.end(), column) - t.columns.begin();
  return t.cells.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
}

TEST(Scores, AreOneForRealOrRightAndStepsOfAScale) {
  const Study study = test::small();
  EXPECT_EQ(score_of(study, answered(1, "turing", "ts1", 0)).value, 1) << "taken for real";
  EXPECT_EQ(score_of(study, answered(1, "turing", "tr1", 1)).value, 0);
  EXPECT_EQ(score_of(study, answered(1, "opinion", "or1", 3)).value, 4);
  EXPECT_EQ(score_of(study, answered(1, "reading", "is2", 0)).value, 1);
  EXPECT_EQ(score_of(study, answered(1, "reading", "is2", 1)).value, 0);
  const auto measures = measures_of(study, {});
  EXPECT_EQ(measures[0].chance(), 0.5);
  EXPECT_EQ(measures[2].chance(), 0.5);
  EXPECT_TRUE(std::isnan(measures[1].chance()));
  EXPECT_EQ(measures[1].most(), 5);
  EXPECT_EQ(clips_shown(study.tests[0]), 4u);
  EXPECT_EQ(clips_shown(study.tests[1]), 4u) << "one of each category, where two are asked for";
}

TEST(Scores, AreMeansOfEachPerson) {
  const Study study = test::small();
  const Answers answers{
      {person(1, 0), person(2, 0)},
      {answered(1, "opinion", "or1", 4), answered(1, "opinion", "or2", 2), answered(2, "opinion", "or1", 0)}};
  const auto means = means_of(measures_of(study, answers)[1].scores);
  EXPECT_EQ(means, (Means{{1, 4}, {2, 1}}));
}

TEST(Findings, RefuseAnswersThatDoNotFit) {
  Answers answers{{person(1, 0)}, {answered(1, "turing", "tr1", 0)}};
  EXPECT_EQ(refusal(answers), "");
  const auto with = [&](const Answer& answer) {
    Answers more = answers;
    more.answers.push_back(answer);
    return refusal(more);
  };
  EXPECT_THAT(with(answered(1, "turing", "tr1", 1)), HasSubstr("clip \"tr1\": given twice"));
  EXPECT_THAT(with(answered(2, "turing", "tr1", 1)), HasSubstr("participant 2 "));
  EXPECT_THAT(with(answered(1, "touring", "tr1", 1)), HasSubstr("no such test"));
  EXPECT_THAT(with(answered(1, "turing", "or1", 1)), HasSubstr("no such clip"));
  EXPECT_THAT(with(answered(1, "turing", "tr2", 2)), HasSubstr("option 2, where there are 2"));
  EXPECT_THAT(with(answered(1, "reading", "ir1", -1)), HasSubstr("option -1"));
  Answer other = answered(1, "turing", "tr2", 0);
  other.question = "good";
  EXPECT_THAT(with(other), HasSubstr("does not ask that"));
}

TEST(Findings, DifferencesOfThirdsAreTies) {
  Study study = test::small();
  for (const int from : {0, 2}) {
    study.tests[0].clips.push_back(study.tests[0].clips[from]);
    study.tests[0].clips.back().id = from == 0 ? "tr3" : "ts3";
  }
  Answers answers;
  const std::vector<std::pair<int, int>> taken_for_real = {{3, 2}, {2, 1}, {1, 2}};  // real and synthetic clips, of 3
  for (const auto& [real, synthetic] : taken_for_real) {
    const auto id = static_cast<std::int64_t>(answers.participants.size() + 1);
    answers.participants.push_back(person(id, 0));
    for (int clip = 1; clip <= 3; ++clip) {
      answers.answers.push_back(answered(id, "turing", "tr" + std::to_string(clip), clip <= real ? 0 : 1));
      answers.answers.push_back(answered(id, "turing", "ts" + std::to_string(clip), clip <= synthetic ? 0 : 1));
    }
  }
  const Findings findings = find(study, answers);
  EXPECT_NEAR(comparison(findings, "turing", Kind::clips, "Ann").p_paired, 1, 1e-12)
      << "three differences of one size; four of eight choices of signs are as extreme on either side";
}

TEST(Findings, CompareRealWithSyntheticOverPeople) {
  const Study study = test::small();
  const Findings findings = find(study, test::opinions());
  const Comparison& all = comparison(findings, "opinion", Kind::clips, "all clips");
  EXPECT_EQ(values_of(all.first), (std::vector<double>{5, 4, 4}));
  EXPECT_EQ(values_of(all.second), (std::vector<double>{1, 2, 3}));
  EXPECT_NEAR(all.difference(), 13 / 3.0 - 2, 1e-12);
  EXPECT_EQ(all.test.statistic, 9);
  EXPECT_EQ(all.test.effect, 1);
  EXPECT_NEAR(all.test.p, 2 / 20.0, 1e-12) << "one choice of C(6, 3) at either end";
  EXPECT_NEAR(all.p_corrected, 0.3, 1e-12) << "recorded eyes, static eyes and all";
  EXPECT_NEAR(all.p_paired, 2 / 8.0, 1e-12) << "differences 4, 2, 1 of one sign";
  EXPECT_NEAR(all.p_paired_corrected, 0.75, 1e-12);
  const Table table = table_of({all}, findings.measures[1]);
  EXPECT_NEAR(cell(table, "all clips", "real"), 13 / 3.0, 1e-12);
  EXPECT_NEAR(cell(table, "all clips", "real std"), std::sqrt(1 / 3.0), 1e-12);
  EXPECT_NEAR(cell(table, "all clips", "synthetic std"), 1, 1e-12);
  EXPECT_EQ(cell(table, "all clips", "synthetic people"), 3);
  EXPECT_EQ(cell(table, "all clips", "A"), 1);
  EXPECT_TRUE(std::isnan(comparison(findings, "turing", Kind::clips, "Ann").test.p)) << "not answered";
}

TEST(Findings, CompareEyes) {
  const Study study = test::small();
  const Findings findings = find(study, test::opinions());
  const Comparison& eyes = comparison(findings, "opinion", Kind::eyes, "Ann, synthetic");
  EXPECT_EQ(eyes.first_name, "recorded eyes");
  EXPECT_EQ(eyes.first, eyes.second) << "rated alike";
  EXPECT_EQ(eyes.test.p, 1);
  EXPECT_EQ(std::count_if(findings.comparisons.begin(), findings.comparisons.end(),
                          [](const Comparison& c) { return c.kind == Kind::eyes; }),
            2)
      << "a row more for all speakers only where there are several; none in tests without eyes";
}

TEST(Findings, CountOnlyWhoAnsweredOrWhoFinished) {
  const Study study = test::small();
  Answers answers = test::opinions();
  answers.participants.push_back(person(4, 0));
  const Findings all = find(study, answers), finished = find(study, answers, {.finished_only = true});
  EXPECT_EQ(all.took_part, 4u);
  EXPECT_EQ(all.finished, 2u);
  EXPECT_EQ(all.people.size(), 3u);
  EXPECT_EQ(finished.people.size(), 2u);
  EXPECT_EQ(finished.measures[1].scores.size(), 8u);
  EXPECT_EQ(cell(progress(finished), "took part", "people"), 4);
  EXPECT_EQ(cell(progress(finished), "count here", "people"), 2);
}

/// People 1 and 2 native, 3 and 4 not, 5 does not say; right answers to ir1, ir2 and is1, is2.
Answers readings() {
  Answers all{{person(1, 0), person(2, 0), person(3, 1), person(4, 1), person(5, 2)}, {}};
  const std::vector<std::array<int, 4>> right = {{1, 1, 1, 1}, {1, 1, 1, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 0, 0}};
  const std::array clips = {"ir1", "ir2", "is1", "is2"};
  for (std::size_t p = 0; p < right.size(); ++p)
    for (std::size_t c = 0; c < 4; ++c)
      all.answers.push_back(
          answered(static_cast<std::int64_t>(p) + 1, "reading", clips[c], 1 - right[p][c], c % 2 + 1));
  return all;
}

TEST(Findings, SplitPeopleByTheirProfile) {
  const Study study = test::small();
  const Findings findings = find(study, readings());
  const Comparison& groups = comparison(findings, "reading", Kind::groups, "Ann, real");
  EXPECT_EQ(groups.first_name, "native: yes");
  EXPECT_EQ(groups.second_name, "native: no");
  EXPECT_EQ(groups.first, (Means{{1, 1}, {2, 1}}));
  EXPECT_EQ(groups.second, (Means{{3, 0.5}, {4, 0}})) << "who does not say is in no group";
  EXPECT_NEAR(groups.test.p, 2 / 6.0, 1e-12);
  EXPECT_TRUE(std::isnan(groups.p_paired)) << "nobody is in both";
  const Comparison& within = comparison(findings, "reading", Kind::clips_in_groups, "Ann, native: no");
  EXPECT_EQ(within.first, (Means{{3, 0.5}, {4, 0}}));
  EXPECT_EQ(within.second, (Means{{3, 0}, {4, 0}}));
  EXPECT_EQ(comparison(findings, "reading", Kind::clips, "Ann").first.size(), 5u);
  const Table table = table_of({groups}, findings.measures[2]);
  EXPECT_NEAR(cell(table, "Ann, real", "h"), cohens_h(1, 0.25), 1e-12);
}

TEST(Findings, TellReplaysApart) {
  const Study study = test::small();
  const Findings findings = find(study, readings());
  const Comparison& plays = comparison(findings, "reading", Kind::plays, "real clips");
  EXPECT_EQ(plays.first, (Means{{1, 1}, {2, 1}, {3, 1}, {4, 0}, {5, 1}})) << "ir1, seen once";
  EXPECT_EQ(plays.second, (Means{{1, 1}, {2, 1}, {3, 0}, {4, 0}, {5, 1}})) << "ir2, seen twice";
  const Table table = by_plays(findings.measures[2], 0.95);
  EXPECT_NEAR(cell(table, "1", "real"), 0.8, 1e-12);
  EXPECT_NEAR(cell(table, "2", "synthetic"), 0.2, 1e-12);
  EXPECT_EQ(cell(table, "2", "synthetic answers"), 5);
  EXPECT_NEAR(cell(table, "1", "real low"), student_interval({1, 1, 1, 0, 1}, 0.95).low, 1e-12);
  EXPECT_EQ(cell(table, "3 or more", "real answers"), 0);
  EXPECT_TRUE(std::isnan(cell(table, "3 or more", "real")));
}

TEST(Tables, CountConfusionsByAnswers) {
  const Study study = test::small();
  Answers answers{{person(1, 0), person(2, 0)}, {}};
  answers.answers = {answered(1, "turing", "tr1", 0), answered(1, "turing", "tr2", 1), answered(1, "turing", "ts1", 0),
                     answered(2, "turing", "tr1", 0), answered(2, "turing", "ts1", 0), answered(2, "turing", "ts2", 1)};
  const Table table = confusions(find(study, answers).measures[0], 0.95);
  EXPECT_EQ(table.rows, (std::vector<std::string>{"Ann"})) << "one speaker is all";
  EXPECT_NEAR(cell(table, "Ann", "synthetic as real"), 2 / 3.0, 1e-12);
  EXPECT_NEAR(cell(table, "Ann", "real as synthetic"), 1 / 3.0, 1e-12);
  EXPECT_EQ(cell(table, "Ann", "synthetic as real answers"), 3);
  EXPECT_NEAR(cell(table, "Ann", "synthetic as real low"), 0.20765960080204782, 1e-10) << "Wilson, 2 of 3";
  EXPECT_NEAR(cell(table, "Ann", "synthetic as real high"), 0.9385080552796038, 1e-10);
}

TEST(Tables, CrossQuestionsOfTheProfile) {
  Study study = test::small();
  study.profile.insert(study.profile.begin(), {"age_band", "How old are you?", {"young", "old", "not to say"}});
  study.profile.push_back({"sex", "", {"f", "m", "not to say"}});
  Answers answers = test::opinions();
  answers.participants[0].profile["age_band"] = 0;
  answers.participants[1].profile["age_band"] = 1;
  answers.participants[2].profile["age_band"] = 1;
  const auto tables = demographics(find(study, answers));
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].title, "age band and native");
  EXPECT_EQ(tables[0].columns, (std::vector<std::string>{"yes", "no", "not to say", "all"}));
  EXPECT_EQ(tables[0].cells,
            (std::vector<std::vector<double>>{{1, 0, 0, 1}, {1, 1, 0, 2}, {0, 0, 0, 0}, {2, 1, 0, 3}}));
  EXPECT_EQ(tables[1].title, "sex");
  EXPECT_EQ(cell(tables[1], "not to say", "all"), 3) << "nobody was asked";
}

TEST(Tables, TellTimesOfThoseWhoFinished) {
  const Study study = test::small();
  Answers answers = test::opinions();
  answers.answers.pop_back();  // 3 has not finished the test
  const Table table = times(find(study, answers));
  EXPECT_EQ(cell(table, "Good?", "people"), 2);
  EXPECT_NEAR(cell(table, "Good?", "minutes"), 40 / 60.0, 1e-12);
  EXPECT_EQ(cell(table, "Good?", "seconds a clip"), 10);
  EXPECT_EQ(cell(table, "Good?", "plays of a clip"), 1);
  EXPECT_TRUE(std::isnan(cell(table, "Real?", "minutes")));
  EXPECT_NEAR(cell(table, "the whole study, with pauses", "minutes"), 12.5, 1e-12) << "10 and 15";
  EXPECT_NEAR(cell(table, "the whole study, with pauses", "minutes upper quartile"), 13.75, 1e-12);
}

TEST(Tables, HaveNamesOfTheirOwn) {
  const Study study = test::small();
  std::vector<std::string> names;
  for (const auto& [name, table] : tables_of(find(study, readings()))) names.push_back(name);
  for (const char* name :
       {"people", "people-1", "times", "turing.real.confusions", "reading.sentence.by-plays",
        "opinion.how_natural.eyes", "reading.sentence.groups", "reading.sentence.real-synthetic-by-group"})
    EXPECT_THAT(names, testing::Contains(name));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace talkgraph::study
