#include "annotate/annotations.h"

#include <atomic>
#include <thread>

#include "tests/nodes/media/media_test.h"

namespace talkgraph::annotate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

using AnnotationsTest = MediaTest;

Shape points(double x) { return (Shape(3, 2) << x, 2, 3, 4.25, 5, 6).finished(); }

TEST_F(AnnotationsTest, AreFilesWhichAnotherProcessFinds) {
  Annotations annotations(folder_ / "a", 3);
  EXPECT_FALSE(annotations.read("s1", 12));
  const auto draft = annotations.write("s1", 12, {points(1.5), false}, "none");
  EXPECT_TRUE(draft.kept);
  EXPECT_TRUE(fs::exists(folder_ / "a/s1/000012.draft"));
  EXPECT_FALSE(fs::exists(folder_ / "a/s1/000012.pts"));
  const auto done = annotations.write("s1", 12, {points(1.75), true}, tag_of(draft.now));
  EXPECT_TRUE(done.kept);
  EXPECT_FALSE(fs::exists(folder_ / "a/s1/000012.draft"));
  EXPECT_THAT(bytes(path("a/s1/000012.pts")), HasSubstr("n_points: 3\n{\n2.75 3\n4 5.25\n6 7\n}"));
  const auto again = Annotations(folder_ / "a", 3).read("s1", 12);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->done);
  EXPECT_EQ(again->points, points(1.75));
  EXPECT_EQ(tag_of(again), tag_of(done.now));
  const auto reopened = annotations.write("s1", 12, {points(1.75), false}, tag_of(again));
  EXPECT_TRUE(reopened.kept);
  EXPECT_FALSE(fs::exists(folder_ / "a/s1/000012.pts"));
  EXPECT_NE(tag_of(reopened.now), tag_of(again)) << "done or not is part of the state";
}

TEST_F(AnnotationsTest, AChangeOfAnOldStateIsRefused) {
  Annotations annotations(folder_, 3);
  const auto first = annotations.write("s1", 0, {points(1), false}, "none");
  const auto second = annotations.write("s1", 0, {points(2), false}, tag_of(first.now));
  const auto late = annotations.write("s1", 0, {points(3), false}, tag_of(first.now));
  EXPECT_FALSE(late.kept);
  EXPECT_EQ(late.now->points, points(2));
  EXPECT_FALSE(annotations.write("s1", 0, {points(3), false}, "none").kept);
  EXPECT_EQ(tag_of(annotations.read("s1", 0)), tag_of(second.now));
}

TEST_F(AnnotationsTest, OfManyWritersOneWinsEachRound) {
  Annotations annotations(folder_, 3);
  for (int round = 0; round < 20; ++round) {
    const auto tag = tag_of(annotations.read("s1", 0));
    std::atomic<int> kept = 0;
    std::vector<std::thread> writers;
    for (int w = 0; w < 4; ++w)
      writers.emplace_back([&, w] {
        kept += annotations.write("s1", 0, {points(100 * round + w), w % 2 == 0}, tag).kept;
      });
    for (auto& writer : writers) writer.join();
    EXPECT_EQ(kept, 1);
  }
}

TEST_F(AnnotationsTest, WhatAKilledProcessLeftIsPutInOrder) {
  write("s1/000003.draft", "{\n1 1\n2 2\n3 4\n}\n");
  write("s1/000004.part-999999999-1.pts", "{\n1 1\n");
  write("s1/000005.pts", "{\n1 1\n2 2\n3 3\n}\n");
  write("s1/notes.pts", "mine");
  Annotations annotations(folder_, 3);
  EXPECT_FALSE(fs::exists(folder_ / "s1/000004.part-999999999-1.pts"));
  EXPECT_FALSE(annotations.read("s1", 3)->done);
  EXPECT_EQ(annotations.read("s1", 3)->points(2, 1), 3);
  EXPECT_THAT(annotations.frames("s1"), ElementsAre(3, 5));
  EXPECT_TRUE(annotations.frames("s2").empty());
  EXPECT_TRUE(fs::exists(folder_ / "s1/notes.pts"));
}

TEST_F(AnnotationsTest, BadFilesAreNamed) {
  write("s1/000003.pts", "{\n1 1\n}\n");
  write("s1/000004.pts", "{\n1 x\n}\n");
  Annotations annotations(folder_, 3);
  EXPECT_THAT(error_of([&] { annotations.read("s1", 3); }), HasSubstr("000003.pts: holds 1 points, the scheme has 3"));
  EXPECT_THAT(error_of([&] { annotations.read("s1", 4); }), HasSubstr("000004.pts:2: a number is expected"));
  write("file", "");
  Annotations blocked(folder_ / "file", 3);
  EXPECT_THAT(error_of([&] { blocked.write("s1", 0, {points(1), true}, "none"); }), HasSubstr("file"));
}

}  // namespace
}  // namespace talkgraph::annotate
