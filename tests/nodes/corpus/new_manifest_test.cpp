#include "nodes/corpus/new_manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/corpus/manifest_file.h"
#include "tests/temporary_folder.h"

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
