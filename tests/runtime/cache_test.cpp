#include "runtime/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CacheTest : public testing::Test {
 protected:
  static Key key(int n) { return KeyMaker().add(std::to_string(n)).key(); }
  std::uint64_t keep(int n, std::uint64_t bits = 7, const fs::path& written = {}) {
    Cache::Result result;
    result.outputs = {Value::of(Mark{bits}), Value()};
    result.warnings = {"mind this"};
    result.seconds = 1.5;
    return cache_.store(key(n), {{"item", "u"}}, result, written);
  }
  Cache::Result get(int n) { return cache_.load(key(n), join_, folder_.path() / "run"); }
  fs::path entry(int n) const {
    const std::string name = key(n).str();
    return cache_.folder() / name.substr(0, 2) / name;
  }
  std::string damage(int n) {
    try {
      get(n);
    } catch (const Cache::Damaged& e) {
      return e.what();
    }
    return "none";
  }

  const test::TemporaryFolder folder_;
  const Registry registry_ = toy::registry();
  const NodeType& join_ = *registry_.find("toy.join");
  Cache cache_{folder_.path() / "cache"};
};

TEST_F(CacheTest, GivesBackWhatItGot) {
  EXPECT_FALSE(cache_.has(key(1)));
  const auto bytes = keep(1);
  ASSERT_TRUE(cache_.has(key(1)));
  const auto result = get(1);
  EXPECT_EQ(bytes, fs::file_size(entry(1) / "0.h5"));
  EXPECT_EQ(result.bytes, bytes);
  EXPECT_EQ(result.outputs.at(0).get<Mark>().bits, 7u);
  EXPECT_FALSE(result.outputs.at(1)) << "a nothing stays one";
  EXPECT_EQ(result.warnings, std::vector<std::string>{"mind this"});
  EXPECT_EQ(result.seconds, 1.5);
  EXPECT_EQ(cache_.verify(key(1)), "");
  EXPECT_TRUE(fs::is_empty(cache_.folder() / "work"));
}

TEST_F(CacheTest, KeepsTheFilesOfSinks) {
  folder_.write("made/clips/a.mp4", "pictures");
  folder_.write("made/b.txt", "text");
  keep(1, 7, folder_.path() / "made");
  get(1);
  EXPECT_EQ(folder_.read("run/clips/a.mp4"), "pictures");
  EXPECT_EQ(folder_.read("run/b.txt"), "text");
}

TEST_F(CacheTest, TheFirstOfTwoEqualsStays) {
  keep(1);
  EXPECT_NO_THROW(keep(1));
  EXPECT_EQ(get(1).outputs[0].get<Mark>().bits, 7u);
  EXPECT_EQ(cache_.entries().size(), 1u);
}

TEST_F(CacheTest, DamageIsFoundAndRemoved) {
  const auto truncate = [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); };
  const auto flip = [](const fs::path& file) {
    std::fstream f(file, std::ios::in | std::ios::out | std::ios::binary);
    f.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
    const char c = static_cast<char>(f.peek() ^ 1);
    f.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
    f.put(c);
  };
  const std::vector<std::function<void()>> harms = {
      [&] { truncate(entry(1) / "0.h5"); },
      [&] { flip(entry(1) / "0.h5"); },
      [&] { fs::remove(entry(1) / "0.h5"); },
      [&] { truncate(entry(1) / "entry.json"); },
      [&] { flip(entry(1) / "entry.json"); },
      [&] { fs::copy_file(entry(1) / "0.h5", entry(1) / "1.h5"); },
      [&] {
        keep(2, 8);
        fs::remove_all(entry(1));
        fs::rename(entry(2), entry(1));
      },
  };
  for (std::size_t i = 0; i < harms.size(); ++i) {
    keep(1);
    harms[i]();
    EXPECT_NE(cache_.verify(key(1)), "") << i;
    EXPECT_THAT(damage(1), HasSubstr(key(1).str())) << i;
    EXPECT_FALSE(cache_.has(key(1))) << i;
  }
}

TEST_F(CacheTest, TheLongestUnusedGoFirst) {
  for (int n = 0; n < 4; ++n) keep(n);
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (int n = 0; n < 4; ++n) fs::last_write_time(entry(n) / "entry.json", old + std::chrono::minutes(n));
  cache_.has(key(0));
  const auto all = cache_.entries();
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all.front().key, key(1));
  EXPECT_EQ(all.back().key, key(0));
  EXPECT_EQ(all.back().about["item"], "u");
  const auto freed = cache_.prune(2 * all[0].bytes);
  EXPECT_EQ(freed, all[0].bytes + all[1].bytes);
  EXPECT_TRUE(cache_.has(key(0)));
  EXPECT_FALSE(cache_.has(key(1)));
  EXPECT_FALSE(cache_.has(key(2)));
}

TEST_F(CacheTest, StaysBelowItsLimit) {
  keep(0);
  const auto one = cache_.entries()[0].bytes;
  Cache::Result result;
  result.outputs = {Value::of(Mark{1}), Value()};
  {
    Cache small(folder_.path() / "small", 5 * one);
    for (int n = 0; n < 30; ++n) small.store(key(n), {{"item", "u"}}, result, {});
    EXPECT_EQ(small.entries().size(), 30u) << "what is in use stays";
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (int n = 0; n < 29; ++n) {
      const std::string name = key(n).str();
      fs::last_write_time(small.folder() / name.substr(0, 2) / name / "entry.json", old);
    }
    small.store(key(30), {{"item", "u"}}, result, {});
    small.store(key(31), {{"item", "u"}}, result, {});
    EXPECT_LE(small.entries().size(), 6u);
    for (int n = 32; n < 40; ++n) small.store(key(n), {{"item", "u"}}, result, {});
  }
  Cache again(folder_.path() / "small");
  EXPECT_LE(again.entries().size(), 5u) << "the limit holds when the cache is closed";
}

TEST_F(CacheTest, AnEntryWithoutItsListIsFoundAndReplaced) {
  keep(1);
  fs::remove(entry(1) / "entry.json");
  ASSERT_EQ(cache_.entries().size(), 1u);
  EXPECT_NE(cache_.verify(cache_.entries()[0].key), "");
  EXPECT_FALSE(cache_.has(key(1)));
  keep(1);
  EXPECT_EQ(cache_.verify(key(1)), "");
}

TEST_F(CacheTest, WhatAnotherProcessRemovedIsSaidToBeGone) {
  keep(1);
  EXPECT_TRUE(cache_.remove(key(1)));
  EXPECT_TRUE(cache_.remove(key(1)));
  EXPECT_THAT(damage(1), HasSubstr("was removed by another run"));
}

TEST_F(CacheTest, WhatAnEndedProcessLeftBehindIsSweptUp) {
  const fs::path left = cache_.folder() / "work" / "999999999-abc";
  const fs::path busy = cache_.folder() / "work" / (std::to_string(getpid()) + "-abc");
  fs::create_directories(left / "x");
  fs::create_directories(busy);
  Cache again(folder_.path() / "cache");
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(busy));
}

TEST_F(CacheTest, ManyMayWriteAtOnce) {
  std::vector<std::thread> writers;
  for (int w = 0; w < 4; ++w)
    writers.emplace_back([&] {
      for (int n = 0; n < 20; ++n) keep(n, static_cast<std::uint64_t>(n));
    });
  for (auto& w : writers) w.join();
  for (int n = 0; n < 20; ++n) EXPECT_EQ(get(n).outputs[0].get<Mark>().bits, static_cast<std::uint64_t>(n));
}

TEST_F(CacheTest, SaysWhereItCannotBe) { EXPECT_THROW(Cache(folder_.write("in_the_way", "x")), std::runtime_error); }

}  // namespace
}  // namespace talkgraph
