#include "study/choose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/source_folder.h"

namespace talkgraph::study {
namespace {

using testing::HasSubstr;

/// The source's design.
Design source_design() {
  Diagnostics diagnostics;
  auto design = load_design(test::source("/pipelines/studies/study.json"), diagnostics);
  EXPECT_TRUE(design) << diagnostics.str();
  return *std::move(design);
}

Speaker speaker(const std::string& title, int sequences) {
  Speaker out{title, {}, {}};
  for (int i = 0; i < sequences; ++i)
    out.sequences.push_back({title + std::to_string(i), "This is sentence " + std::to_string(100 + i), 2.0 + i});
  return out;
}

struct Chosen {
  std::optional<Study> study;
  std::vector<std::string> notes;
  Diagnostics diagnostics;
};

Chosen choose_from(const Design& design, const std::vector<Speaker>& speakers) {
  Chosen out;
  out.study = choose(design, speakers, out.notes, out.diagnostics);
  return out;
}

std::map<std::string, int> by_category(const Test& test) {
  std::map<std::string, int> count;
  for (const auto& clip : test.clips) ++count[clip.category()];
  return count;
}

std::map<std::string, int> uses(const Study& study) {
  std::map<std::string, int> count;
  for (const auto& test : study.tests)
    for (const auto& clip : test.clips) ++count[clip.sequence];
  return count;
}

std::vector<std::string> lines(const Study& study) {
  std::vector<std::string> out;
  for (const auto& test : study.tests)
    for (const auto& c : test.clips)
      out.push_back(test.id + c.id + c.sequence + c.category() + std::to_string(c.correct));
  return out;
}

TEST(Choose, MakesTheSourcesStudyOfTwoRuns) {
  const auto chosen = choose_from(source_design(), {speaker("LIPS", 200), speaker("DEMNOW", 200)});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  const auto& tests = chosen.study->tests;
  ASSERT_EQ(tests.size(), 3u);
  EXPECT_EQ(tests[0].per_category, 4);
  EXPECT_EQ(tests[1].per_category, 3);
  EXPECT_EQ(tests[2].per_category, 3);
  EXPECT_EQ(by_category(tests[0]),
            (std::map<std::string, int>{
                {"LIPS, real", 15}, {"LIPS, synthetic", 15}, {"DEMNOW, real", 15}, {"DEMNOW, synthetic", 15}}));
  EXPECT_EQ(by_category(tests[1]).size(), 8u);
  for (const auto& [category, count] : by_category(tests[1])) EXPECT_EQ(count, 3) << category;
  for (const auto& [category, count] : by_category(tests[2])) EXPECT_EQ(count, 15) << category;
  EXPECT_TRUE(chosen.notes.empty());
  for (const auto& [sequence, count] : uses(*chosen.study)) EXPECT_EQ(count, 1) << sequence;
}

TEST(Choose, ShowsTwiceAsManyOfOneRun) {
  const auto chosen = choose_from(source_design(), {speaker("Ann", 500)});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  EXPECT_EQ(chosen.study->tests[0].per_category, 8);
  EXPECT_EQ(chosen.study->tests[1].per_category, 6);
  EXPECT_EQ(chosen.study->tests[2].per_category, 6);
  EXPECT_EQ(chosen.study->tests[0].clips.size(), 60u);
}

// What people see comes first, so that nobody sees a sequence twice: 4 + 4, 4 × 3 and 3 + 3 of a run.
TEST(Choose, LetsPoolsGrowOnlyBySequencesThatAreLeftOver) {
  const auto chosen = choose_from(source_design(), {speaker("A", 30), speaker("B", 26)});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  EXPECT_TRUE(chosen.notes.empty());
  for (const auto& [sequence, count] : uses(*chosen.study)) EXPECT_EQ(count, 1) << sequence;
  EXPECT_EQ(uses(*chosen.study).size(), 56u);
  for (const auto& test : chosen.study->tests) {
    const auto count = by_category(test);
    if (!test.clips.front().eyes.empty()) continue;
    EXPECT_EQ(count.at("B, real"), test.per_category);
    EXPECT_EQ(count.at("B, synthetic"), test.per_category);
    EXPECT_EQ(count.at("A, real"), test.per_category + 1);
    EXPECT_EQ(count.at("A, synthetic"), test.per_category + 1);
  }
}

TEST(Choose, RepeatsSequencesBetweenTestsBeforeWithinOne) {
  auto design = source_design();
  const auto chosen = choose_from(design, {speaker("A", 24)});  // of 16 + 24 + 12 clips
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  ASSERT_EQ(chosen.notes.size(), 1u);
  EXPECT_THAT(chosen.notes[0], HasSubstr("A: 24 sequences do not suffice"));
  for (const auto& test : chosen.study->tests) {
    std::set<std::string> seen;
    for (const auto& clip : test.clips) EXPECT_TRUE(seen.insert(clip.sequence).second) << test.id << clip.sequence;
  }
  for (const auto& [sequence, count] : uses(*chosen.study)) EXPECT_LE(count, 3) << sequence;
}

TEST(Choose, NeverRepeatsASequenceInACategory) {
  const auto chosen = choose_from(source_design(), {speaker("A", 8)});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  for (const auto& test : chosen.study->tests) {
    std::set<std::string> seen;
    for (const auto& clip : test.clips) EXPECT_TRUE(seen.insert(clip.category() + clip.sequence).second);
  }
}

TEST(Choose, GoesByItsSeed) {
  auto design = source_design();
  const std::vector<Speaker> speakers = {speaker("A", 90), speaker("B", 90)};
  const auto a = choose_from(design, speakers), b = choose_from(design, speakers);
  design.seed = 2;
  const auto c = choose_from(design, speakers);
  EXPECT_EQ(lines(*a.study), lines(*b.study));
  EXPECT_NE(lines(*a.study), lines(*c.study));
}

TEST(Choose, NamesOfClipsTellNothing) {
  const auto chosen = choose_from(source_design(), {speaker("A", 90), speaker("B", 90)});
  std::set<std::string> names;
  for (const auto& test : chosen.study->tests) {
    EXPECT_TRUE(
        std::is_sorted(test.clips.begin(), test.clips.end(), [](const auto& a, const auto& b) { return a.id < b.id; }));
    for (const auto& clip : test.clips) {
      EXPECT_EQ(clip.id.size(), 12u);
      EXPECT_TRUE(names.insert(clip.id).second);
    }
  }
}

TEST(Choose, OffersSentencesOfAboutTheSameLength) {
  auto design = source_design();
  Speaker one = speaker("A", 200);
  for (int i = 0; i < 200; ++i)
    one.sequences[static_cast<std::size_t>(i)].sentence =
        i < 100 ? "Short " + std::to_string(100 + i)
                : "A sentence that is a good deal longer " + std::to_string(100 + i);
  const auto chosen = choose_from(design, {one});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  std::set<int> positions;
  for (const auto& clip : chosen.study->tests[2].clips) {
    ASSERT_EQ(clip.choices.size(), 4u);
    EXPECT_EQ(std::set(clip.choices.begin(), clip.choices.end()).size(), 4u);
    const auto right =
        std::find_if(one.sequences.begin(), one.sequences.end(), [&](const auto& s) { return s.id == clip.sequence; });
    EXPECT_EQ(clip.choices.at(static_cast<std::size_t>(clip.correct)), right->sentence);
    for (const auto& choice : clip.choices) EXPECT_EQ(choice.size(), right->sentence.size());
    positions.insert(clip.correct);
  }
  EXPECT_EQ(positions.size(), 4u);
}

TEST(Choose, TakesFalseSentencesFromOthersOfTheSpeaker) {
  auto design = source_design();
  Speaker one = speaker("A", 40);
  for (auto& s : one.sequences) s.sentence = "bin blue now";
  one.sentences = {"Bin blue, now!", "set blue now", "set white now", "lay white now"};
  const auto chosen = choose_from(design, {one});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  for (const auto& clip : chosen.study->tests[2].clips)
    EXPECT_THAT(clip.choices,
                testing::UnorderedElementsAre("bin blue now", "set blue now", "set white now", "lay white now"));
}

TEST(Choose, TakesFalseSentencesThatAreHeardElsewhereFirst) {
  Speaker one = speaker("A", 40);
  one.sentences = {"This is sentence of training", "This is another sentence"};
  const auto chosen = choose_from(source_design(), {one});
  ASSERT_TRUE(chosen.study) << chosen.diagnostics.str();
  for (const auto& clip : chosen.study->tests[2].clips)
    EXPECT_THAT(clip.choices, testing::Each(HasSubstr("This is sentence 1"))) << clip.id;
}

TEST(Choose, SaysWhereThereAreTooFew) {
  const auto design = source_design();
  const auto complaint = [&](const std::vector<Speaker>& speakers) {
    const auto chosen = choose_from(design, speakers);
    EXPECT_FALSE(chosen.study);
    return chosen.diagnostics.str();
  };
  EXPECT_THAT(complaint({speaker("A", 7)}),
              testing::AllOf(HasSubstr("study.json:"), HasSubstr("test \"turing\": 8 sequences are needed"),
                             HasSubstr("A has 7 held out: at most 14 clips")));
  EXPECT_THAT(
      complaint({speaker("A", 50), speaker("B", 50), speaker("C", 50)}),
      testing::AllOf(HasSubstr("16 clips cannot be shared evenly among 6 categories"), HasSubstr("take 12 or 18")));
  auto same = speaker("A", 50), silent = same;
  for (auto& s : same.sequences) s.sentence = "Always the same";
  EXPECT_THAT(complaint({same}), HasSubstr("4 sentences to choose from, but all transcripts of A make 1 different"));
  for (auto& s : silent.sequences) s.sentence.clear();
  EXPECT_THAT(complaint({silent}), HasSubstr("make 0 different"));
  auto unlike = speaker("A", 10);
  for (std::size_t i = 0; i < 10; ++i) unlike.sequences[i].sentence = std::string(std::size_t{2} << i, 'a');
  EXPECT_THAT(complaint({unlike}), HasSubstr("with 3 other sentences of about the same length"));
}

TEST(ByLength, GroupsWhatDiffersByAQuarterAtMost) {
  EXPECT_EQ(by_length({"abcdefghijk", "abcd", "ABCD.", "abcde", "abcdef", "", "..."}),
            (std::vector<std::vector<std::string>>{{"abcd", "abcde"}, {"abcdef"}, {"abcdefghijk"}}));
}

}  // namespace
}  // namespace talkgraph::study
