#include "runtime/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/executor.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RunFolderTest : public testing::Test {
 protected:
  RunFolderTest() {
    b_.graph.name = "pipelines/lips.json";
    b_.graph.resolved = {{"description", "lips"}};
    b_.output("out", b_.add("track", "toy.fail_at", {b_.add("source", "toy.source")}, {{"key", "u3"}}));
  }
  Json record() const { return Json::parse(read(home_ / "run/run.json")); }

  const Registry registry_ = toy::registry();
  GraphBuilder b_{registry_};
  const test::TemporaryFolder temporary_;
  const fs::path home_ = temporary_.path();
};

TEST_F(RunFolderTest, RecordsARun) {
  RunFolder folder(b_.graph, home_ / "run");
  EXPECT_EQ(record()["status"], "running");
  RunOptions options;
  options.keep_going = true;
  options.observers = {&folder};
  run(b_.graph, options);
  const auto json = record();
  EXPECT_EQ(json["status"], "finished with failures");
  EXPECT_EQ(json["graph"], "pipelines/lips.json");
  EXPECT_GT(json["peak_memory_bytes"], 1'000'000);
  EXPECT_EQ(json["failures"][0]["item"], "u3");
  EXPECT_EQ(json["nodes"][1]["name"], "track");
  EXPECT_EQ(json["nodes"][1]["calls"], 10);
  EXPECT_EQ(Json::parse(read(home_ / "run/graph.resolved.json")), b_.graph.resolved);
  EXPECT_THAT(read(home_ / "run/log.txt"), HasSubstr("item \"u3\": the picture is black"));
  for (const auto& entry : fs::directory_iterator(home_ / "run"))
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos);
}

TEST_F(RunFolderTest, RecordsAFailureAndACancellation) {
  RunFolder folder(b_.graph, home_ / "run");
  RunOptions options;
  options.observers = {&folder};
  EXPECT_THROW(run(b_.graph, options), RunError);
  EXPECT_EQ(record()["status"], "failed");
  EXPECT_THAT(record()["error"], HasSubstr("node \"track\""));
  const std::atomic<bool> cancel{true};
  options.cancel = &cancel;
  EXPECT_THROW(run(b_.graph, options), Cancelled);
  EXPECT_EQ(record()["status"], "cancelled");
}

TEST_F(RunFolderTest, RecordsACancellationBeforeTheFirstNode) {
  RunFolder folder(b_.graph, home_ / "run");
  Cache cache(home_ / "cache");
  RunOptions options;
  options.observers = {&folder};
  options.cache = &cache;
  const std::atomic<bool> cancel{true};
  options.cancel = &cancel;
  EXPECT_THROW(run(b_.graph, options), Cancelled);
  EXPECT_EQ(record()["status"], "cancelled");
}

TEST_F(RunFolderTest, ClearsWhatAnEarlierRunWroteAndNothingElse) {
  const auto run_to = [&](const std::string& clips, int items) {
    GraphBuilder b(registry_);
    b.graph.resolved = Json::object();
    b.output("out",
             b.add("write", "toy.write", {b.add("source", "toy.source", {}, {{"to", items}})}, {{"folder", clips}}));
    RunFolder folder(b.graph, home_ / "run");
    RunOptions options;
    options.folder = folder.path();
    options.observers = {&folder};
    run(b.graph, options);
  };
  temporary_.write("run/before.txt", "mine");
  run_to("clips/all", 2);
  EXPECT_EQ(record()["files"], (Json{"clips/all/u0.txt", "clips/all/u1.txt"}));
  temporary_.write("run/after.txt", "mine");
  temporary_.write("outside.txt", "mine");
  auto forged = record();
  forged["files"].push_back("../outside.txt");
  temporary_.write("run/run.json", forged.dump());
  run_to("one", 1);
  EXPECT_FALSE(fs::exists(home_ / "run/clips"));
  EXPECT_TRUE(fs::exists(home_ / "run/one/u0.txt"));
  for (const char* kept : {"run/before.txt", "run/after.txt", "outside.txt"})
    EXPECT_EQ(temporary_.read(kept), "mine") << kept;
}

TEST_F(RunFolderTest, ClearsWhatAKilledRunWrote) {
  const auto written = temporary_.file("run/clips/a b\n.txt");
  {
    RunFolder killed(b_.graph, home_ / "run");
    killed.writes("clips/a b\n.txt");
    killed.writes("never.txt");
    temporary_.write("run/clips/a b\n.txt", "half done");
    temporary_.write("run/mine.txt", "mine");
  }
  RunFolder next(b_.graph, home_ / "run");
  EXPECT_FALSE(fs::exists(written));
  EXPECT_FALSE(fs::exists(home_ / "run/clips"));
  EXPECT_EQ(temporary_.read("run/mine.txt"), "mine");
  RunOptions options;
  options.observers = {&next};
  EXPECT_THROW(run(b_.graph, options), RunError);
  EXPECT_FALSE(fs::exists(home_ / "run/.written")) << "run.json lists the files now";
}

TEST_F(RunFolderTest, ANodesFilesAreKnownBeforeTheyAreThere) {
  GraphBuilder b(registry_);
  b.graph.resolved = Json::object();
  b.output("out", b.add("write", "toy.write", {b.add("source", "toy.source", {}, {{"to", 2}})}, {{"folder", "all"}}));
  struct Watch : RunObserver {
    void writes(const std::string& file) override {
      EXPECT_FALSE(fs::exists(folder / file));
      files.push_back(file);
    }
    fs::path folder;
    std::vector<std::string> files;
  } watch;
  watch.folder = home_ / "run";
  RunOptions options;
  options.executor = Executor::serial;
  options.folder = watch.folder;
  options.observers = {&watch};
  run(b.graph, options);
  EXPECT_THAT(watch.files, testing::UnorderedElementsAre("all/u0.txt", "all/u1.txt"));
}

TEST_F(RunFolderTest, NamesItselfAfterGraphAndTime) {
  const auto before = fs::current_path();
  fs::current_path(home_);
  const RunFolder one(b_.graph), two(b_.graph);
  const std::string started = Json::parse(read(one.path() / "run.json"))["started"];
  fs::current_path(before);
  const auto digits = [](std::string text) {
    std::erase_if(text, [](char c) { return c < '0' || c > '9'; });
    return text;
  };
  EXPECT_EQ(digits(one.path().string()), digits(started));
  EXPECT_THAT(one.path().string(), testing::MatchesRegex("runs/lips-[0-9]+T[0-9]+Z"));
  EXPECT_NE(one.path(), two.path());
}

TEST_F(RunFolderTest, SaysWhatCannotBeWritten) {
  try {
    RunFolder folder(b_.graph, "/proc/none/run");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("the run folder /proc/none/run cannot be used"));
  }
}

}  // namespace
}  // namespace talkgraph
