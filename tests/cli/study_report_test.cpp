#include "cli/study_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/session.h"
#include "study/store.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

using testing::HasSubstr;

study::Study one_test() {
  study::Study study;
  study.title = "Ann";
  study.profile = {{"native", "Is English your first language?", {"yes", "no", "not to say"}}};
  study.split_by = "native";
  study.tests = {{"turing", study::TestKind::turing, "Real?", {}, {{"real", "", {"real", "synthetic"}}}, 1, {}}};
  for (const bool synthetic : {false, true})
    study.tests[0].clips.push_back({synthetic ? "b" : "a", "Ann", "s1", synthetic, "", 1, {}, -1});
  return study;
}

TEST(StudyReport, IsOfWhatTheStoreKeeps) {
  const test::TemporaryFolder folder;
  const auto study = one_test();
  study::write_study(study, folder.path());
  EXPECT_THROW(run_study_report(folder.path(), {}), std::runtime_error) << "nobody was asked yet";

  study::Store store(folder.path(), study);
  EXPECT_EQ(run_study_report(folder.path(), {}), 0);
  EXPECT_THAT(folder.read("report/report.html"), HasSubstr("Nobody has taken part yet."));

  const auto token = store.invite(false);
  store.agree(*store.find(*token));
  store.keep_profile(*store.find(*token), {{"native", 1}});
  const auto shown = study::plan(study, store.find(*token)->seed);
  for (std::size_t i = 0; i < shown.size(); ++i)
    store.keep(*store.find(*token), i, {{0, "turing", shown[i].clip->id, "real", 0, shown[i].position, 1, 2.5, 0}},
               i + 1 == shown.size());
  StudyReportCommand command;
  command.output = folder.path() / "elsewhere";
  EXPECT_EQ(run_study_report(folder.path(), command), 0);
  EXPECT_THAT(folder.read("elsewhere/report.html"), HasSubstr("1 person took part"));
  EXPECT_THAT(folder.read("elsewhere/answers.csv"), HasSubstr("turing,real,b,Ann,s1,synthetic,,0,real,1,"));
}

}  // namespace
}  // namespace talkgraph::cli
