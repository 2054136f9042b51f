#include "nodes/speech/register.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(Register, DescribesEveryNode) {
  Registry registry;
  register_speech(registry);
  EXPECT_THAT(
      registry.names(),
      testing::ElementsAre("speech.all_pole", "speech.average", "speech.bark", "speech.cepstrum", "speech.deltas",
                           "speech.energy", "speech.frame", "speech.frame_preemphasis", "speech.join",
                           "speech.loudness", "speech.mel", "speech.one_hot", "speech.preemphasis", "speech.rasta",
                           "speech.remove_mean", "speech.spectrum", "speech.stack", "speech.window"));
}

}  // namespace
}  // namespace talkgraph
