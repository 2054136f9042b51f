#include "nodes/plot/register.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(RegisterPlot, DescribesEveryNode) {
  Registry registry;
  register_plot(registry);
  for (const char* name :
       {"plot.bars", "plot.columns", "plot.contexts", "plot.convergence", "plot.curves", "plot.latent",
        "plot.mean_trajectory", "plot.phone_means", "plot.tracks", "plot.trajectories"})
    EXPECT_TRUE(registry.find(name)) << name;
}

}  // namespace
}  // namespace talkgraph
