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
      testing::ElementsAre("speech.all_pole", "speech.average", "speech.bark", "speech.cepstrum", "speech.deemphasis",
                           "speech.deltas", "speech.energy", "speech.f0", "speech.frame", "speech.frame_preemphasis",
                           "speech.from_lsf", "speech.join", "speech.loudness", "speech.lpc", "speech.lsf",
                           "speech.mel", "speech.one_hot", "speech.place", "speech.preemphasis", "speech.rasta",
                           "speech.reflection", "speech.remove_mean", "speech.residual", "speech.resynthesise",
                           "speech.spectrum", "speech.stack", "speech.window"));
}

}  // namespace
}  // namespace talkgraph
