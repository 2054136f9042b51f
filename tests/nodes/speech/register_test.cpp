#include "nodes/speech/register.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(Register, DescribesEveryNode) {
  Registry registry;
  register_speech(registry);
  EXPECT_THAT(registry.names(),
              testing::ElementsAre("speech.cepstrum", "speech.deltas", "speech.energy", "speech.frame", "speech.join",
                                   "speech.mel", "speech.one_hot", "speech.preemphasis", "speech.spectrum",
                                   "speech.stack", "speech.window"));
}

}  // namespace
}  // namespace talkgraph
