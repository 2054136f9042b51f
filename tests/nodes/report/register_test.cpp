#include "nodes/report/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterReport, DescribesEveryNode) {
  Registry registry;
  register_report(registry);
  EXPECT_TRUE(registry.find("report.write"));
}

}  // namespace
}  // namespace talkgraph
