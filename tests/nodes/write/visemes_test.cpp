#include "nodes/write/visemes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

TEST(VisemeText, IsWhatRhubarbWrites) {
  const PhoneTrack phones{{{"sil", 0, 0.5}, {"aa", 0.5, 0.7}}};
  EXPECT_EQ(viseme_text(phones, VisemeFormat::tsv, "a"), "0.00\tX\n0.50\tD\n0.70\tX\n");
  const auto json = nlohmann::json::parse(viseme_text(phones, VisemeFormat::json, "a \"b\".wav"));
  EXPECT_EQ(json["metadata"]["soundFile"], "a \"b\".wav");
  EXPECT_EQ(json["metadata"]["duration"], 0.7);
  ASSERT_EQ(json["mouthCues"].size(), 2u);
  EXPECT_EQ(json["mouthCues"][1]["start"], 0.5);
  EXPECT_EQ(json["mouthCues"][1]["end"], 0.7);
  EXPECT_EQ(json["mouthCues"][1]["value"], "D");
  EXPECT_EQ(viseme_text({}, VisemeFormat::tsv, ""), "0.00\tX\n");
  EXPECT_TRUE(nlohmann::json::parse(viseme_text({}, VisemeFormat::json, ""))["mouthCues"].empty());
}

TEST(WriteVisemes, NamesTheFileForTheItem) {
  const test::TemporaryFolder folder;
  Context context;
  context.folder = folder.path();
  context.item = "clip1";
  EXPECT_EQ((WriteVisemes{VisemeFormat::json, "out"}({{{"m", 0, 1}}}, context).path), "out/clip1.json");
  EXPECT_TRUE(std::filesystem::exists(context.folder / "out/clip1.json"));
}

TEST(WriteVisemes, RefusesWhatIsNoPhone) {
  const test::TemporaryFolder folder;
  Context context;
  context.folder = folder.path();
  EXPECT_THROW(WriteVisemes{}({{{"quack", 0, 1}}}, context), std::exception);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace talkgraph
