#include "graph/output_file.h"

#include <gmock/gmock.h>

#include <thread>
#include <vector>

#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(OutputFile, IsSeenOnlyWhenItIsWhole) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "new/clip.mp4";
  {
    OutputFile file(path);
    EXPECT_EQ(fs::path(file.part()).extension(), ".mp4");
    std::ofstream(file.part()) << "half";
    EXPECT_FALSE(fs::exists(path));
  }
  EXPECT_TRUE(fs::is_empty(path.parent_path())) << "what was not finished is removed";
  OutputFile file(path);
  std::ofstream(file.part()) << "whole";
  file.finish();
  EXPECT_EQ(folder.read("new/clip.mp4"), "whole");
}

TEST(WriteFile, ReplacesAFileOrLeavesItAsItIs) {
  const test::TemporaryFolder folder;
  write_file(folder.path() / "a.txt", "one");
  write_file(folder.path() / "a.txt", "two");
  EXPECT_EQ(folder.read("a.txt"), "two");
  const auto complaint = [](const fs::path& path) {
    try {
      write_file(path, "x");
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(complaint("/dev/full/x"), HasSubstr("/dev/full"));
  EXPECT_THAT(complaint("/proc/nowhere.txt"), HasSubstr("/proc/nowhere.txt: cannot be written"));
  EXPECT_THAT(complaint(folder.path() / "a.txt" / "b.txt"), HasSubstr("a.txt: this folder cannot be made"));
  fs::create_directory(folder.path() / "folder");
  EXPECT_THAT(complaint(folder.path() / "folder"), HasSubstr("folder: cannot be written"));
}

TEST(OutputFile, ThreadsMayWriteTheSameFile) {
  const test::TemporaryFolder folder;
  std::vector<std::jthread> threads;
  for (const char digit : {'1', '2', '3', '4'})
    threads.emplace_back([&folder, digit] {
      for (int i = 0; i < 200; ++i) EXPECT_NO_THROW(write_file(folder.path() / "a.txt", std::string(100, digit)));
    });
  threads.clear();
  const auto text = folder.read("a.txt");
  EXPECT_EQ(text, std::string(100, text.at(0)));
}

TEST(OutputFile, WhatAKilledProcessLeftIsSwept) {
  const test::TemporaryFolder folder;
  folder.write("clips/a.part-99999999-1.mp4", "half");
  folder.write("b.part-99999999-1", "half");
  folder.write("c.part-" + std::to_string(getpid()) + "-1.txt", "at work");
  folder.write("part-1.txt", "a name");
  folder.write(".desk-99999999-abc/a.txt", "half");
  sweep_parts(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.file("clips/a.part-99999999-1.mp4")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.part-99999999-1")));
  EXPECT_EQ(folder.read("c.part-" + std::to_string(getpid()) + "-1.txt"), "at work");
  EXPECT_EQ(folder.read("part-1.txt"), "a name");
  EXPECT_FALSE(std::filesystem::exists(folder.file(".desk-99999999-abc")));
}

}  // namespace
}  // namespace talkgraph
