#include "nodes/write/audio.h"

#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class WritesAudio : public MediaTest {
 protected:
  void SetUp() override {
    context.folder = folder_;
    context.item = "u1";
  }
  Context context;
};

TEST_F(WritesAudio, WhatIsReadBack) {
  const Artifact file = WriteAudio{"out", "a-", "-b", WavFormat::float32}(tone(0.1, 16000), context);
  EXPECT_EQ(file.path, "out/a-u1-b.wav");
  EXPECT_TRUE(read_audio(path(file.path)).samples.isApprox(tone(0.1, 16000).samples, 1e-6));
}

TEST_F(WritesAudio, WholeOrNotAtAll) {
  EXPECT_EQ(WriteAudio{}(Audio{}, context).path, "sound/u1.wav") << "silence of no length is sound";
  std::filesystem::remove(path("sound/u1.wav"));
  EXPECT_THROW(WriteAudio{}(Audio{Eigen::Vector3d(0, NAN, 0), 8000}, context), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "sound"));
}

}  // namespace
}  // namespace talkgraph
