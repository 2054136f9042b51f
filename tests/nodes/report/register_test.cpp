#include "nodes/report/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterReport, DescribesEveryNode) {
  Registry registry;
  register_report(registry);
  for (const char* name : {"report.latent", "report.write"}) EXPECT_TRUE(registry.find(name)) << name;
}

}  // namespace
}  // namespace talkgraph
