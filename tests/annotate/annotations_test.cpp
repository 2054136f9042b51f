#include "annotate/annotations.h"

#include <atomic>
#include <set>
#include <thread>

#include "tests/nodes/media/media_test.h"

namespace talkgraph::annotate {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

using AnnotationsTest = MediaTest;

Shape points(double x) { return (Shape(3, 2) << x, 2, 3, 4.25, 5, 6).finished(); }

TEST_F(AnnotationsTest, AreFilesWhichAnotherProcessFinds) {
  Annotations annotations(folder_ / "a", 3);
  EXPECT_FALSE(annotations.read("s1", 12).annotation);
  const auto draft = annotations.write("s1", 12, {points(1.5), false}, "none");
  EXPECT_TRUE(draft.kept);
  EXPECT_TRUE(fs::exists(folder_ / "a/s1/000012.draft"));
  EXPECT_FALSE(fs::exists(folder_ / "a/s1/000012.pts"));
  const auto done = annotations.write("s1", 12, {points(1.75), true}, tag_of(draft.now));
  EXPECT_TRUE(done.kept);
  EXPECT_FALSE(fs::exists(folder_ / "a/s1/000012.draft"));
  EXPECT_THAT(bytes(path("a/s1/000012.pts")), HasSubstr("n_points: 3\n{\n2.75 3\n4 5.25\n6 7\n}"));
  const auto again = Annotations(folder_ / "a", 3).read("s1", 12);
  ASSERT_TRUE(again.annotation);
  EXPECT_TRUE(again.annotation->done);
  EXPECT_EQ(again.annotation->points, points(1.75));
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
  EXPECT_EQ(late.now.annotation->points, points(2));
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
  EXPECT_FALSE(annotations.read("s1", 3).annotation->done);
  EXPECT_EQ(annotations.read("s1", 3).annotation->points(2, 1), 3);
  EXPECT_THAT(annotations.frames("s1"), ElementsAre(3, 5));
  EXPECT_TRUE(annotations.frames("s2").empty());
  EXPECT_TRUE(fs::exists(folder_ / "s1/notes.pts"));
}

TEST_F(AnnotationsTest, BadFilesAreNamedAndPutAsideByTheNextChange) {
  write("s1/000003.pts", "{\n1 1\n}\n");
  write("s1/000004.pts", "{\n1 x\n}\n");
  write("s1/000004.pts.broken", "older");
  Annotations annotations(folder_, 3);
  EXPECT_THAT(annotations.read("s1", 3).broken, HasSubstr("000003.pts: holds 1 points, the scheme has 3"));
  const auto bad = annotations.read("s1", 4);
  EXPECT_THAT(bad.broken, HasSubstr("000004.pts:2: a number is expected"));
  EXPECT_FALSE(bad.annotation);
  EXPECT_FALSE(annotations.write("s1", 4, {points(1), true}, "none").kept) << "it is no new frame";
  EXPECT_TRUE(annotations.write("s1", 4, {points(1), true}, tag_of(bad)).kept);
  EXPECT_EQ(annotations.read("s1", 4).annotation->points, points(1));
  EXPECT_EQ(bytes(path("s1/000004.pts.broken")), "older");
  EXPECT_EQ(bytes(path("s1/000004.pts.broken.broken")), "{\n1 x\n}\n");
  EXPECT_THAT(annotations.frames("s1"), ElementsAre(3, 4));
}

TEST_F(AnnotationsTest, AFolderThatCannotBeMadeIsNamed) {
  write("file", "");
  Annotations blocked(folder_ / "file", 3);
  EXPECT_THAT(error_of([&] { blocked.write("s1", 0, {points(1), true}, "none"); }), HasSubstr("file"));
}

TEST_F(AnnotationsTest, AnyNumberOfDigitsNamesAFrame) {
  write("s1/7.pts", "{\n1 1\n2 2\n3 4\n}\n");
  write("s1/0012.DRAFT", "{\n1 1\n2 2\n3 4\n}\n");
  Annotations annotations(folder_, 3);
  EXPECT_THAT(annotations.frames("s1"), ElementsAre(7, 12));
  const auto seven = annotations.read("s1", 7), twelve = annotations.read("s1", 12);
  ASSERT_TRUE(seven.annotation);
  EXPECT_TRUE(seven.annotation->done);
  ASSERT_TRUE(twelve.annotation);
  EXPECT_FALSE(twelve.annotation->done);
  EXPECT_TRUE(annotations.write("s1", 7, {points(1), false}, tag_of(seven)).kept);
  EXPECT_TRUE(annotations.write("s1", 12, {points(2), true}, tag_of(twelve)).kept);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "s1")) names.insert(entry.path().filename().string());
  EXPECT_THAT(names, ElementsAre("0012.pts", "7.draft"));
}

TEST_F(AnnotationsTest, TwoFilesOfOneFrameAreRefused) {
  const std::string text = "{\n1 1\n2 2\n3 4\n}\n";
  for (const std::string other : {"7.pts", "000007.draft"}) {
    write("s1/000007.pts", text);
    write("s1/" + other, text);
    Annotations annotations(folder_, 3);
    const auto both = annotations.read("s1", 7);
    EXPECT_FALSE(both.annotation);
    EXPECT_THAT(both.broken, AllOf(HasSubstr("000007.pts"), HasSubstr(other), HasSubstr("remove one of them")));
    EXPECT_THAT(annotations.frames("s1"), ElementsAre(7));
    EXPECT_TRUE(annotations.write("s1", 7, {points(1), true}, tag_of(both)).kept);
    EXPECT_EQ(annotations.read("s1", 7).annotation->points, points(1));
    EXPECT_EQ(bytes(path("s1/" + other + ".broken")), text);
    fs::remove_all(path("s1"));
  }
}

}  // namespace
}  // namespace talkgraph::annotate
