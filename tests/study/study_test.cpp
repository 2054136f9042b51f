#include "study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "graph/output_file.h"

namespace talkgraph::study {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct StudyFile : testing::Test {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "study_file";
  Study study;

  StudyFile() {
    std::filesystem::create_directories(folder);
    const Question real{"real", "Is it real?", {"real", "synthetic"}};
    const Question which{"sentence", "What was said?", {}};
    study.title = "Faces";
    study.consent = {"You may stop at any time."};
    study.profile = {{"native", "Is English your first language?", {"yes", "no", "prefer not to say"}}};
    study.split_by = "native";
    study.tests = {
        {"turing", TestKind::turing, "Real?", {"Look."}, {real}, 1, {{"a1", "Ann", "s1", true, "", 2.5, {}, -1}}},
        {"read",
         TestKind::intelligibility,
         "Read",
         {},
         {which},
         1,
         {{"b1", "Ann", "s2", false, "static", 2, {"one", "two"}, 1}}}};
  }

  std::string refusal() const {
    try {
      read_study(folder);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return {};
  }
};

TEST_F(StudyFile, ComesBackAsItWasWritten) {
  write_study(study, folder);
  const auto back = read_study(folder);
  EXPECT_EQ(back.title, "Faces");
  EXPECT_EQ(back.profile[0].options, study.profile[0].options);
  ASSERT_EQ(back.tests.size(), 2u);
  EXPECT_EQ(back.tests[1].kind, TestKind::intelligibility);
  EXPECT_EQ(back.tests[0].clips[0].category(), "Ann, synthetic");
  EXPECT_EQ(back.tests[1].clips[0].category(), "Ann, real, static eyes");
  EXPECT_EQ(back.tests[1].clips[0].choices, (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(back.tests[1].clips[0].correct, 1);
  EXPECT_DOUBLE_EQ(back.tests[0].clips[0].seconds, 2.5);
}

TEST_F(StudyFile, IsRefusedByName) {
  std::filesystem::remove(folder / "study.json");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("study.json"), HasSubstr("study make")));
  write_file(folder / "study.json", "{");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("study.json"), HasSubstr("is no study")));
  write_file(folder / "study.json", R"({"title": 3})");
  EXPECT_THAT(refusal(), HasSubstr("is no study"));
}

TEST_F(StudyFile, OfAnUnknownKindOfTestIsRefused) {
  write_study(study, folder);
  std::ifstream in(folder / "study.json");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  write_file(folder / "study.json", text.replace(text.find("\"turing\",\n      \"title"), 8, "\"touring\""));
  EXPECT_THAT(refusal(), HasSubstr("touring"));
}

TEST_F(StudyFile, NamesLeadNowhereElseAndAreThereOnce) {
  study.tests[0].clips[0].id = "../a1";
  EXPECT_THROW(write_study(study, folder), std::runtime_error);
  study.tests[0].clips[0].id = "b1";
  EXPECT_THROW(write_study(study, folder), std::runtime_error);
}

TEST_F(StudyFile, HasARightChoiceAndSomethingToShow) {
  study.tests[1].clips[0].correct = 2;
  EXPECT_THROW(write_study(study, folder), std::runtime_error);
  study.tests[1].clips.clear();
  EXPECT_THROW(write_study(study, folder), std::runtime_error);
  study.tests.pop_back();
  study.split_by = "tongue";
  EXPECT_THROW(write_study(study, folder), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph::study
