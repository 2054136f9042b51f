#include "experiment/crew.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/experiment/scored_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using Status = TrialResult::Status;

class CrewTest : public testing::Test {
 protected:
  CrewTest() { folder_.write("graph.json", test::scored_graph); }

  std::vector<TrialResult> run(const std::string& members, CrewOptions options = {}) {
    Diagnostics diagnostics;
    const auto file = folder_.write("e.json", R"({ "graph": "graph.json", "tabulate": ["scores"], )" + members + "}");
    experiment_ = load_experiment(file, diagnostics);
    EXPECT_TRUE(experiment_) << diagnostics.str();
    const auto graphs = load_trials(*experiment_, registry_, diagnostics);
    EXPECT_TRUE(graphs) << diagnostics.str();
    options.folder = folder_.path() / "out";
    std::vector<TrialResult> results;
    run_trials(*experiment_, *graphs, options, results);
    return results;
  }

  const test::TemporaryFolder folder_;
  const Registry registry_ = test::scored_registry();
  std::optional<Experiment> experiment_;
};

TEST_F(CrewTest, RunsEveryTrial) {
  for (const int threads : {1, 2, 5}) {
    CrewOptions options;
    options.threads = threads;
    const auto results = run(R"("vary": { "scale": [1, 2, 3], "offset": [0, 10] }, "show": ["files"])", options);
    ASSERT_EQ(results.size(), 6u);
    for (std::size_t t = 0; t < 6; ++t) {
      EXPECT_EQ(results[t].status, Status::finished) << results[t].error;
      ASSERT_EQ(results[t].observations.size(), 6u);  // y and title of three items
      const double scale = 1 + std::floor(static_cast<double>(t) / 2), offset = t % 2 ? 10 : 0;
      EXPECT_EQ(results[t].observations[3].measure, "y");
      EXPECT_EQ(results[t].observations[3].item, "2");
      EXPECT_EQ(results[t].observations[3].value, 2 * scale + offset);
      EXPECT_EQ(results[t].shown.size(), 3u);
      EXPECT_TRUE(
          std::filesystem::exists(folder_.path() / "out/trials" / experiment_->trials[t].name / "pictures/1.svg"));
    }
  }
}

TEST_F(CrewTest, SeedsGiveOtherNumbersAndTheSameOnesAgain) {
  const auto a = run(R"("set": { "noise": 1 }, "seeds": [5, 6])"), b = run(R"("set": { "noise": 1 }, "seeds": [5, 6])");
  EXPECT_NE(a[0].observations[1].value, a[1].observations[1].value);
  EXPECT_EQ(a[0].observations[1].value, b[0].observations[1].value);
  EXPECT_EQ(a[1].observations[1].value, b[1].observations[1].value);
}

TEST_F(CrewTest, AFailedTrialDoesNotStopTheOthers) {
  const auto results = run(R"("vary": { "fail_on": [-1, 2, 9] })");
  EXPECT_EQ(results[0].status, Status::finished);
  EXPECT_EQ(results[1].status, Status::failed);
  EXPECT_THAT(results[1].error, testing::HasSubstr("not liked"));
  EXPECT_EQ(results[2].status, Status::finished);
}

TEST_F(CrewTest, KeepsGoingWithinATrialIfAsked) {
  CrewOptions options;
  options.keep_going = true;
  const auto results = run(R"("vary": { "fail_on": [2] })", options);
  EXPECT_EQ(results[0].status, Status::failed);
  EXPECT_EQ(results[0].failures, 1u);
  EXPECT_EQ(results[0].observations.size(), 4u);
}

TEST_F(CrewTest, SharesTheCacheAndFindsAllTheSecondTime) {
  Cache cache(folder_.path() / "cache");
  CrewOptions options;
  options.cache = &cache;
  std::string warnings;
  options.on_warning = [&](std::size_t, std::string_view message) { warnings += message; };
  const std::string members = R"("vary": { "scale": [1, 2, 3, 4] })";
  test::scored = 0;
  const auto first = run(members, options);
  EXPECT_EQ(test::scored, 12);
  EXPECT_EQ(warnings, "");
  const auto second = run(members, options);
  EXPECT_EQ(test::scored, 12);
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_GT(second[t].loaded, 0u);
    ASSERT_EQ(first[t].observations.size(), second[t].observations.size());
    for (std::size_t o = 0; o < first[t].observations.size(); ++o)
      EXPECT_EQ(first[t].observations[o].value, second[t].observations[o].value);
  }
}

TEST_F(CrewTest, StopsAndGoesOnWhereItWas) {
  Cache cache(folder_.path() / "cache");
  CrewOptions options;
  options.cache = &cache;
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  options.on_change = [&](std::size_t, const TrialResult& r) {
    if (r.status == Status::finished) cancel = true;
  };
  const std::string members = R"("vary": { "scale": [1, 2, 3, 4] })";
  const auto stopped = run(members, options);
  EXPECT_EQ(stopped[0].status, Status::finished);
  EXPECT_NE(stopped[3].status, Status::finished);
  options.cancel = nullptr;
  options.on_change = nullptr;
  test::scored = 0;
  for (const auto& result : run(members, options)) EXPECT_EQ(result.status, Status::finished);
  EXPECT_EQ(test::scored, 9);
}

TEST_F(CrewTest, ATightMemoryBudgetRunsOneAtATime) {
  CrewOptions options;
  options.threads = 4;
  options.memory = 1;
  int at_work = 0, most = 0;
  options.on_change = [&](std::size_t, const TrialResult& r) {
    at_work += r.status == Status::waiting ? 1 : -1;
    most = std::max(most, at_work);
  };
  for (const auto& r : run(R"("vary": { "scale": [1, 2, 3, 4, 5, 6] })", options))
    EXPECT_EQ(r.status, Status::finished);
  EXPECT_EQ(most, 1);
}

TEST_F(CrewTest, AListenerThatFailsIsToldOfOnceAndStopsNothing) {
  CrewOptions options;
  options.on_change = [](std::size_t, const TrialResult&) { throw std::runtime_error("the disk is full"); };
  std::string warnings;
  options.on_warning = [&](std::size_t, std::string_view message) { warnings += message; };
  for (const auto& r : run(R"("vary": { "scale": [1, 2, 3] })", options)) EXPECT_EQ(r.status, Status::finished);
  EXPECT_EQ(warnings, "the disk is full");
}

TEST_F(CrewTest, OfAnEarlierRunNothingIsLeftAndAllElseStays) {
  run(R"("vary": { "scale": [1] })");
  const auto trial = folder_.path() / "out/trials/scale=1";
  ASSERT_TRUE(std::filesystem::exists(trial / "pictures/3.svg"));
  folder_.write("out/trials/scale=1/pictures/notes.txt", "mine");
  run(R"("vary": { "scale": [1] }, "set": { "nodes.items.params.items": 2 })");
  EXPECT_FALSE(std::filesystem::exists(trial / "pictures/3.svg"));
  EXPECT_TRUE(std::filesystem::exists(trial / "pictures/2.svg"));
  EXPECT_EQ(folder_.read("out/trials/scale=1/pictures/notes.txt"), "mine");
}

}  // namespace
}  // namespace talkgraph
