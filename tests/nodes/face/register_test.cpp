#include "nodes/face/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterFace, OffersItsNodes) {
  Registry registry;
  register_face(registry);
  EXPECT_EQ(registry.names().size(), 23u);
  EXPECT_TRUE(registry.find("face.track")->stored);
  EXPECT_TRUE(registry.find("face.prototypes")->uses_random);
}

}  // namespace
}  // namespace talkgraph
