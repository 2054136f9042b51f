#include "cli/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <filesystem>

#include "nodes/all_nodes.h"
#include "nodes/media/audio_file.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

class Run : public testing::Test {
 protected:
  Run() {
    write_audio(folder_.path() / "tone.wav", Audio{Eigen::VectorXd::LinSpaced(1600, -0.5, 0.5), 16000});
    graph_ = folder_.write("g.json", R"({ "nodes": {
        "files": { "type": "corpus.files", "params": { "files": ["tone.wav"] } },
        "parts": { "type": "corpus.parts", "in": { "recording": "files" } },
        "sound": { "type": "write.hdf5", "in": { "value": "parts.audio" } } } })");
    command_.progress = ProgressStyle::quiet;
    command_.folder = folder_.path() / "r1";
  }
  /// The exit code of the program.
  int talkgraph(const std::string& arguments) const {
    const int status = std::system(
        ("cd '" + folder_.path().string() + "' && " TALKGRAPH_PROGRAM " " + arguments + " > out.txt 2> err.txt")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const test::TemporaryFolder folder_;
  const Registry registry_ = all_nodes();
  std::string graph_;
  RunCommand command_;
};

TEST_F(Run, AgainFromWithinARunFolder) {
  ASSERT_EQ(run_file(graph_, command_, registry_), success);
  EXPECT_THROW(run_file(graph_, command_, registry_), std::invalid_argument) << "the folder holds a run";
  const auto before = fs::current_path();
  fs::current_path(command_.folder);
  command_.folder.clear();
  EXPECT_EQ(run_file("graph.resolved.json", command_, registry_), success);
  EXPECT_TRUE(fs::exists("runs"));
  fs::current_path(before);
}

TEST_F(Run, WhatCannotBeWrittenIsToldBeforeTheFolderIsMade) {
  auto traced = command_, kept = command_;
  traced.trace = "/proc/none/trace.json";
  EXPECT_THROW(run_file(graph_, traced, registry_), std::runtime_error);
  kept.cached = true;
  kept.cache = folder_.write("file", "x");
  EXPECT_THROW(run_file(graph_, kept, registry_), std::runtime_error);
  EXPECT_FALSE(fs::exists(command_.folder));
}

TEST_F(Run, SizesAreNotNegative) {
  EXPECT_EQ(talkgraph("run g.json --cache here --cache-size -5"), usage);
  EXPECT_EQ(talkgraph("cache prune --cache . --size -5"), usage);
  EXPECT_THAT(folder_.read("err.txt"), testing::HasSubstr("must not be negative"));
  EXPECT_EQ(talkgraph("run g.json --cache here --cache-size 5MB -o r2"), success) << folder_.read("err.txt");
}

TEST_F(Run, LookingAfterACacheMakesNone) {
  for (const char* command : {"info", "verify", "prune"})
    EXPECT_EQ(talkgraph("cache " + std::string(command) + " --cache typo"), usage);
  EXPECT_FALSE(fs::exists(folder_.path() / "typo"));
}

}  // namespace
}  // namespace talkgraph::cli
