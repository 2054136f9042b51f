#include "cli/speak.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "nodes/all_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

using testing::HasSubstr;

std::string complaint(const SpeakCommand& command) {
  try {
    speak(command, all_nodes());
  } catch (const std::exception& e) {
    return e.what();
  }
  return "nothing";
}

TEST(Speak, SaysWhatIsMissingOrTooMuch) {
  SpeakCommand c;
  c.model = "model.h5";
  c.output = "clip.mp4";
  EXPECT_EQ(complaint(c), "give either recordings or --text");
  c.files = {"a.wav"};
  c.text = "hello";
  EXPECT_EQ(complaint(c), "give either recordings or --text");
  c.text.clear();
  c.transcripts = {"one", "two"};
  EXPECT_EQ(complaint(c), "1 recordings but 2 transcripts: give --transcript once for each recording, in order");
  c.transcripts.clear();
  c.output = "clip.avi";
  EXPECT_EQ(complaint(c), "clip.avi: the name must end in .mp4 or .webm");
  c.output.clear();
  EXPECT_EQ(complaint(c), "say where to write: -o clip.mp4, --visemes FILE, or both");
}

TEST(Speak, ChecksWhereItIsToWriteBeforeAnythingElse) {
  const test::TemporaryFolder folder;
  SpeakCommand one;
  one.model = "model.h5";
  one.files = {"a.wav"};
  one.output = folder.path();
  EXPECT_THAT(complaint(one), HasSubstr("the name must end in .mp4 or .webm"));
  one.output = folder.path() / "CLIP.MP4";
  EXPECT_THAT(complaint(one), HasSubstr("model.h5: there is no such model file"));
  one.visemes = "mouth.txt";
  EXPECT_EQ(complaint(one), "mouth.txt: the name must end in .json or .tsv");

  SpeakCommand several = one;
  several.visemes.clear();
  several.files = {"a.wav", "b.wav"};
  EXPECT_THAT(complaint(several), HasSubstr("several recordings go to a folder"));
  several.output = folder.write("file", "");
  EXPECT_THAT(complaint(several), HasSubstr("is a file; several recordings go to a folder"));
}

TEST(Speak, RefusesFilesThatAreNoModels) {
  SpeakCommand c;
  c.files = {"a.wav"};
  c.output = "clip.mp4";
  c.model = "nowhere.h5";
  EXPECT_EQ(complaint(c), "nowhere.h5: there is no such model file");
  const test::TemporaryFolder folder;
  c.model = folder.write("model.h5", "text");
  EXPECT_EQ(complaint(c), c.model + ": is not an HDF5 file");
}

}  // namespace
}  // namespace talkgraph::cli
