#include "study/design.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::study {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string studies = test::source("/pipelines/studies/");

struct DesignFile : testing::Test {
  const test::TemporaryFolder folder;

  std::optional<Design> load(const std::string& members) {
    const auto file = folder.write(
        "s.json", R"({ "extends": ")" + studies + R"(study.json")" + (members.empty() ? "" : ", ") + members + "}");
    diagnostics = {};
    return load_design(file, diagnostics);
  }
  std::string complaint(const std::string& members) {
    EXPECT_FALSE(load(members)) << members;
    return diagnostics.str();
  }

  Diagnostics diagnostics;
};

TEST_F(DesignFile, IsTheSourcesIfNothingIsChanged) {
  const auto design = load("");
  ASSERT_TRUE(design) << diagnostics.str();
  ASSERT_EQ(design->tests.size(), 3u);
  EXPECT_EQ(design->tests[0].kind, TestKind::turing);
  EXPECT_EQ(design->tests[0].clips, 16);
  EXPECT_EQ(design->tests[0].pool, 60);
  EXPECT_EQ(design->tests[1].clips, 24);
  EXPECT_EQ(design->tests[1].pool, 24);
  EXPECT_EQ(design->tests[1].eyes, (std::vector<std::string>{"recorded", "static"}));
  ASSERT_EQ(design->tests[1].questions.size(), 3u);
  for (const auto& question : design->tests[1].questions) EXPECT_EQ(question.options.size(), 5u);
  EXPECT_EQ(design->tests[2].clips, 12);
  EXPECT_EQ(design->tests[2].choices, 4);
  ASSERT_EQ(design->profile.size(), 4u);
  for (const auto& question : design->profile) EXPECT_EQ(question.options.back(), "prefer not to say");
  EXPECT_EQ(design->split_by, "native");
  EXPECT_TRUE(std::filesystem::exists(design->draw.path));
}

TEST_F(DesignFile, ChangesWhatItNames) {
  const auto design = load(
      R"("seed": 5, "speakers": ["A"], "tests": { "intelligibility": null, "turing": { "clips": 4, "pool": 4 } })");
  ASSERT_TRUE(design) << diagnostics.str();
  EXPECT_EQ(design->seed, 5u);
  ASSERT_EQ(design->tests.size(), 2u);
  EXPECT_EQ(design->tests[0].clips, 4);
  EXPECT_EQ(design->tests[0].questions.size(), 1u);
}

TEST_F(DesignFile, OfTheDemoIsSound) {
  EXPECT_TRUE(load_design(studies + "demo.json", diagnostics)) << diagnostics.str();
}

TEST_F(DesignFile, IsRefusedWithPlaces) {
  EXPECT_THAT(complaint(R"("tests": { "turing": { "clps": 4 } })"),
              AllOf(HasSubstr("s.json:1:"), HasSubstr("did you mean \"clips\"")));
  EXPECT_THAT(complaint(R"("tests": { "turing": { "clips": 0 } })"), HasSubstr("s.json:1:"));
  EXPECT_THAT(complaint(R"("tests": { "turing": { "clips": 61 } })"), HasSubstr("61 clips cannot be drawn from 60"));
  EXPECT_THAT(complaint(R"("tests": { "turing": { "kind": "touring" } })"), HasSubstr("touring"));
  EXPECT_THAT(complaint(R"("tests": { "turing": { "eyes": [] } })"), HasSubstr("unknown key \"eyes\""));
  EXPECT_THAT(complaint(R"("tests": { "perceptual": { "eyes": ["shut"] } })"), HasSubstr("\"recorded\", \"static\""));
  EXPECT_THAT(complaint(R"("tests": { "turing": { "questions": { "real": { "options": ["a", "b", "c"] } } } })"),
              HasSubstr("the options are two"));
  EXPECT_THAT(complaint(R"("tests": { "a b": { "kind": "turing" } })"), HasSubstr("\"a b\" cannot be a name"));
  EXPECT_THAT(complaint(R"("profile": { "age": { "options": ["old"] } })"), HasSubstr("at least two options"));
  EXPECT_THAT(complaint(R"("split_by": "naive")"), HasSubstr("did you mean \"native\""));
  EXPECT_THAT(complaint(R"("take": { "fase": "x.y" })"), HasSubstr("did you mean \"face\""));
  EXPECT_THAT(complaint(R"("draw": "none.json")"), HasSubstr("none.json is not there"));
  EXPECT_THAT(complaint(R"("thanks": null)"), HasSubstr("\"thanks\" is missing"));
}

TEST_F(DesignFile, ThatIsNotThereIsSaid) {
  EXPECT_FALSE(load_design(folder.file("none.json"), diagnostics));
  EXPECT_THAT(diagnostics.str(), HasSubstr("none.json: cannot be read"));
}

}  // namespace
}  // namespace talkgraph::study
