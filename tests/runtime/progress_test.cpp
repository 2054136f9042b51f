#include "runtime/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "runtime/executor.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"

namespace talkgraph {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// A file in memory that progress is written to.
class Paper {
 public:
  ~Paper() {
    std::fclose(file);
    std::free(data_);
  }
  std::string text() {
    std::fflush(file);
    return {data_, size_};
  }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;

 public:
  std::FILE* file = open_memstream(&data_, &size_);
};

class ProgressTest : public testing::Test {
 protected:
  ProgressTest() {
    source_ = b_.add("source", "toy.source");
    track_ = b_.add("track", "toy.map", {source_});
    train_ = b_.add("train", "toy.train", {track_});
    b_.output("out", train_);
  }
  const Registry registry_ = toy::registry();
  GraphBuilder b_{registry_};
  int source_, track_, train_;
};

TEST_F(ProgressTest, TellsItemsTotalRateAndTimeLeft) {
  Paper paper;
  Progress progress(ProgressStyle::plain, paper.file, 1h);
  progress.started(b_.graph);
  progress.domain_size(source_, 40);
  for (int i = 0; i < 10; ++i) {
    progress.call_started(track_, std::to_string(i));
    progress.call_ended(track_, std::to_string(i));
    progress.item_done(track_, std::to_string(i));
  }
  EXPECT_TRUE(progress.lines(Progress::Clock::now()).empty());
  progress.call_started(track_, "10");
  const auto lines = progress.lines(Progress::Clock::now() + 20s);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], HasSubstr("track"));
  EXPECT_THAT(lines[0], HasSubstr("10/40"));
  EXPECT_THAT(lines[0], HasSubstr("0.5/s"));
  EXPECT_THAT(lines[0], HasSubstr("1 min "));  // 30 more at half an item a second
}

TEST_F(ProgressTest, DoesNotCountItemsThatANodeHadNothingToDoFor) {
  Paper paper;
  Progress progress(ProgressStyle::plain, paper.file, 1h);
  progress.started(b_.graph);
  progress.domain_size(source_, 40);
  for (int i = 0; i < 20; ++i) progress.item_done(track_, std::to_string(i));
  for (int i = 20; i < 22; ++i) {
    progress.call_started(track_, std::to_string(i));
    progress.call_ended(track_, std::to_string(i));
    progress.item_done(track_, std::to_string(i));
  }
  progress.call_started(track_, "22");
  EXPECT_THAT(progress.lines(Progress::Clock::now() + 1s).at(0), HasSubstr(" 2/20 "));
}

TEST_F(ProgressTest, TellsWarningsEvenWhenQuiet) {
  Paper paper;
  Progress progress(ProgressStyle::quiet, paper.file);
  progress.started(b_.graph);
  progress.warn(track_, "u3", "half of it is dark");
  EXPECT_EQ(paper.text(), "warning: track, item \"u3\": half of it is dark\n");
}

TEST_F(ProgressTest, TellsTheShareOfANodeThatRunsOnce) {
  Paper paper;
  Progress progress(ProgressStyle::plain, paper.file, 1h);
  progress.started(b_.graph);
  progress.call_started(train_, "");
  EXPECT_THAT(progress.lines(Progress::Clock::now()).at(0), HasSubstr("working"));
  progress.progress(train_, "", 0.25);
  const auto line = progress.lines(Progress::Clock::now() + 10s).at(0);
  EXPECT_THAT(line, HasSubstr("25 %"));
  EXPECT_THAT(line, testing::ContainsRegex("3[01] s left"));
}

TEST_F(ProgressTest, WritesPlainLinesWherePiped) {
  Paper paper;
  Progress progress(ProgressStyle::plain, paper.file, 1ms);
  toy::dawdle_at_most = 3000;
  RunOptions options;
  options.observers = {&progress};
  run(b_.graph, options);
  toy::dawdle_at_most = 0;
  EXPECT_THAT(paper.text(), HasSubstr("track"));
  EXPECT_THAT(paper.text(), Not(HasSubstr("\x1b")));
}

TEST_F(ProgressTest, GivesProgramsAnObjectALine) {
  Paper paper;
  Progress progress(ProgressStyle::json, paper.file, 1ms);
  toy::dawdle_at_most = 3000;
  RunOptions options;
  options.observers = {&progress};
  run(b_.graph, options);
  toy::dawdle_at_most = 0;
  progress.warn(track_, "u3", "half of it is \"dark\"");
  std::istringstream lines(paper.text());
  std::vector<Json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(Json::parse(line));
  ASSERT_GE(events.size(), 4u);
  EXPECT_EQ(events.front(), (Json{{"event", "started"}, {"graph", "test.json"}}));
  bool told = false;
  for (const auto& e : events) told = told || (e["event"] == "progress" && e["node"] == "track" && e["done"] > 0);
  EXPECT_TRUE(told);
  const Json& ended = events[events.size() - 2];
  EXPECT_EQ(ended["event"], "ended");
  EXPECT_EQ(ended["status"], "finished");
  EXPECT_EQ(ended["nodes"].size(), 3u);
  EXPECT_EQ(events.back()["message"], "half of it is \"dark\"");
}

TEST_F(ProgressTest, GivesProgramsTheFailureThatStoppedTheRun) {
  Paper paper;
  Progress progress(ProgressStyle::json, paper.file, 1h);
  progress.started(b_.graph);
  RunReport report;
  report.status = RunReport::Status::failed;
  report.error = "node \"track\": no";
  report.nodes.resize(3);
  progress.failed({"track", "u3", "g.json:1:2", "no"});
  progress.ended(report);
  EXPECT_THAT(paper.text(),
              HasSubstr(R"({"event":"failure","node":"track","item":"u3","place":"g.json:1:2","cause":"no"})"));
  EXPECT_THAT(paper.text(), HasSubstr(R"("status":"failed","seconds":0.0,"error":"node \"track\": no")"));
}

TEST_F(ProgressTest, ClearsItsLinesOnATerminal) {
  Paper paper;
  Progress progress(ProgressStyle::terminal, paper.file, 1ms);
  toy::dawdle_at_most = 3000;
  RunOptions options;
  options.observers = {&progress};
  run(b_.graph, options);
  toy::dawdle_at_most = 0;
  const auto text = paper.text();
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_GT(count("\n"), 0u);
  EXPECT_EQ(count("\n"), count("\x1b[1A\x1b[2K"));
}

TEST(Duration, IsReadable) {
  EXPECT_EQ(duration_text(0), "0 s");
  EXPECT_EQ(duration_text(44.2), "45 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 5 min");
}

}  // namespace
}  // namespace talkgraph
