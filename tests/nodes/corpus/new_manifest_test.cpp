#include "nodes/corpus/new_manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/corpus/manifest_file.h"
#include "tests/temporary_folder.h"
#include "tests/unprivileged.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class NewManifestTest : public testing::Test {
 protected:
  Json make(const NewManifest& node = {}) {
    auto out = node(folder.path());
    notes = out.notes;
    folder.write("manifest.json", out.manifest.dump());
    Diagnostics diagnostics;
    read_manifest(folder.file("manifest.json"), diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << diagnostics.str();
    return out.manifest;
  }

  const test::TemporaryFolder folder;
  std::vector<std::string> notes;
};

constexpr const char* phones = "0 1000000 sil\n1000000 2000000 aa\n";
constexpr const char* words = "0 1000000 sil\n1000000 2000000 good\n";

TEST_F(NewManifestTest, TakesWhatLiesBesideAClip) {
  folder.write("a.mp4", "");
  folder.write("a.wav", "");
  folder.write("a.txt", "Good morning");
  folder.write("a.csv", "frame,x0,y0\n0,1,2\n");
  folder.write("a.lab", phones);
  folder.write("sub/b.MOV", "");
  folder.write("sub/b.align", "0 25000 sil\n25000 50000 good\n");
  folder.write("sub/b.csv", "name,age\n");
  folder.write("notes.txt", "of no clip");
  const auto clips = make()["clips"];
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0], (Json{{"id", "a"},
                            {"video", "a.mp4"},
                            {"audio", "a.wav"},
                            {"landmarks", "a.csv"},
                            {"phones", "a.lab"},
                            {"transcript", "a.txt"}}));
  EXPECT_EQ(clips[1], (Json{{"id", "sub-b"}, {"video", "sub/b.MOV"}, {"words", "sub/b.align"}}));
  EXPECT_TRUE(notes.empty());
}

TEST_F(NewManifestTest, TellsPhonesFromWordsAndFromPlainText) {
  for (const char* name : {"p", "w", "t", "g"}) folder.write(std::string(name) + ".mp4", "");
  folder.write("p.lab", phones);
  folder.write("w.lab", words);
  folder.write("t.lab", "Bin blue\nat F two now\n");
  folder.write(
      "g.TextGrid",
      "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n0\n1\n<exists>\n2\n"
      "\"IntervalTier\"\n\"words\"\n0\n1\n1\n0\n1\n\"good\"\n\"IntervalTier\"\n\"phones\"\n0\n1\n1\n0\n1\n\"g\"\n");
  const auto clips = make()["clips"];
  EXPECT_EQ(clips[0]["id"], "g");
  EXPECT_EQ(clips[0]["words"], "g.TextGrid");
  EXPECT_EQ(clips[0]["phones"], "g.TextGrid");
  EXPECT_EQ(clips[1]["phones"], "p.lab");
  EXPECT_FALSE(clips[1].contains("words"));
  EXPECT_EQ(clips[2]["transcript"], "Bin blue at F two now");
  EXPECT_EQ(clips[3]["words"], "w.lab");
  EXPECT_FALSE(clips[3].contains("phones"));
}

TEST_F(NewManifestTest, SpreadsTheSplitsInTheOrderOfNumbers) {
  for (int i = 1; i <= 20; ++i) folder.write("clip" + std::to_string(i) + ".mp4", "");
  const auto clips = make()["clips"];
  std::map<std::string, std::vector<std::string>> splits;
  for (const auto& clip : clips) splits[clip.value("split", "train")].push_back(clip["id"]);
  EXPECT_THAT(splits["test"], ElementsAre("clip5", "clip15"));
  EXPECT_EQ(splits["validation"].size(), 2u);
  EXPECT_EQ(splits["train"].size(), 16u);
  EXPECT_EQ(clips[1]["id"], "clip2");
  const auto all = make({0, 0, {}})["clips"];
  EXPECT_TRUE(std::none_of(all.begin(), all.end(), [](const auto& c) { return c.contains("split"); }));
}

TEST_F(NewManifestTest, TakesFoldersOfPicturesWithSound) {
  folder.write("a/1.png", "");
  folder.write("a.wav", "");
  folder.write("a-landmarks/1.pts", "");
  folder.write("b/1.png", "");
  NewManifest node;
  node.rate = Rational(30000, 1001);
  const auto manifest = make(node);
  EXPECT_EQ(manifest["rate"], "30000/1001");
  ASSERT_EQ(manifest["clips"].size(), 1u);
  EXPECT_EQ(manifest["clips"][0]["video"], "a");
  EXPECT_EQ(manifest["clips"][0]["landmarks"], "a-landmarks");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("b: passed over, a folder of pictures needs its sound beside it"));
}

TEST_F(NewManifestTest, MakesIdsThatTheLoaderTakes) {
  const std::string wide = "\xc3\xa4", longest(110, 'a');
  std::string umlauts;
  for (int i = 0; i < 60; ++i) umlauts += wide;
  for (const auto& name : {"a-b", "a/b", "a-b-2", "new\nline", "x/tab\there"})
    folder.write(std::string(name) + ".mp4", "");
  for (const auto& name : {longest + "1", longest + "2", umlauts}) folder.write(name + ".mp4", "");
  std::vector<std::string> ids;
  const auto clips = make()["clips"];
  for (const auto& clip : clips) ids.push_back(clip["id"]);
  EXPECT_THAT(ids,
              testing::UnorderedElementsAre("a-b", "a-b-2", "a-b-3", "new-line", "x-tab-here", longest.substr(0, 90),
                                            longest.substr(0, 90) + "-2", umlauts.substr(0, 90)));
}

TEST_F(NewManifestTest, PassesOverWhatCannotBeListed) {
  folder.write("a.mp4", "");
  folder.write("caf\xe9.mp4", "");
  folder.write("caf\xe9/b.mp4", "");
  folder.write("locked/c.mp4", "");
  folder.write("latin.mp4", "");
  folder.write("latin.lab", "gr\xfcn\n");
  std::filesystem::create_symlink("loop", folder.path() / "loop");
  const auto locked = folder.path() / "locked";
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  std::filesystem::permissions(locked, std::filesystem::perms::none);
  const auto clips = [&] {
    const test::Unprivileged here;
    return NewManifest{}(folder.path());
  }();
  std::filesystem::permissions(locked, std::filesystem::perms::owner_all);
  ASSERT_EQ(clips.manifest["clips"].size(), 2u);
  EXPECT_FALSE(clips.manifest["clips"][1].contains("transcript"));
  EXPECT_THAT(clips.notes, testing::UnorderedElementsAre(
                               HasSubstr("caf\xe9.mp4: passed over, its name is not UTF-8; rename it"),
                               HasSubstr("caf\xe9: passed over"), HasSubstr("locked: passed over, Permission denied"),
                               HasSubstr("latin.lab: passed over; it is not UTF-8"), HasSubstr("loop: passed over")));
}

TEST_F(NewManifestTest, ATranscriptMayBeginWithANumber) {
  for (const char* name : {"a", "b", "c", "d"}) folder.write(std::string(name) + ".mp4", "");
  folder.write("d.lab", "#!MLF!#\n\"*/d.lab\"\n0 1000000 sil\n1000000 2000000 aa\n.\n");
  folder.write("a.lab", "10 green bottles\nhanging on the wall\n");
  folder.write("b.lab", "2\n");
  folder.write("c.TXT", "Good morning");
  const auto clips = make()["clips"];
  EXPECT_EQ(clips[0]["transcript"], "10 green bottles hanging on the wall");
  EXPECT_EQ(clips[1]["transcript"], "2");
  EXPECT_EQ(clips[2]["transcript"], "c.TXT");
  EXPECT_EQ(clips[3]["phones"], "d.lab");
  Diagnostics diagnostics;
  EXPECT_EQ(read_manifest(folder.file("manifest.json"), diagnostics)[2].transcript_file, folder.file("c.TXT"));
}

TEST_F(NewManifestTest, SaysWhatItPassesOver) {
  folder.write("a.mp4", "");
  folder.write("a.mov", "");
  folder.write("a.TextGrid", "nonsense");
  folder.write(".hidden/b.mp4", "");
  const auto clips = make()["clips"];
  EXPECT_EQ(clips.size(), 1u);
  EXPECT_THAT(notes,
              testing::UnorderedElementsAre(HasSubstr("has the same name"), HasSubstr("neither phones nor words")));
}

TEST_F(NewManifestTest, ComplainsOfNothingToList) {
  EXPECT_THROW(NewManifest{}(folder.path() / "nowhere"), std::runtime_error);
  folder.write("a.txt", "words");
  EXPECT_THROW(NewManifest{}(folder.path()), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
