#include "runtime/plan.h"

#include <gtest/gtest.h>

#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"

namespace talkgraph {
namespace {

using In = GraphBuilder::In;

class PlanTest : public testing::Test {
 protected:
  const Registry registry_ = toy::registry();
  GraphBuilder b_{registry_};
};

TEST_F(PlanTest, AChainIsOneSweep) {
  const int source = b_.add("source", "toy.source");
  const int a = b_.add("a", "toy.map", {source});
  const int c = b_.add("c", "toy.join", {a, source});
  const Plan plan = make_plan(b_.graph);
  ASSERT_EQ(plan.units.size(), 1u);
  EXPECT_EQ(plan.units[0].domain, source);
  EXPECT_TRUE(plan.units[0].opens);
  EXPECT_EQ(plan.units[0].nodes, (std::vector<int>{a, c}));
}

TEST_F(PlanTest, TrainThenApplySweepsTwice) {
  const int source = b_.add("source", "toy.source");
  const int a = b_.add("a", "toy.map", {source});
  const int train = b_.add("train", "toy.train", {a});
  const int apply = b_.add("apply", "toy.join", {a, train});
  const Plan plan = make_plan(b_.graph);
  ASSERT_EQ(plan.units.size(), 3u);
  EXPECT_EQ(plan.units[0].nodes, std::vector<int>{a});
  EXPECT_EQ(plan.units[1].nodes, std::vector<int>{train});
  EXPECT_EQ(plan.units[2].nodes, std::vector<int>{apply});
  EXPECT_FALSE(plan.units[2].opens);
  EXPECT_EQ(plan.units[2].after, (std::vector<int>{0, 1}));
}

// A stream that needs a model from another one waits for it instead of being held.
TEST_F(PlanTest, ADomainWaitsForAModelFromAnotherOne) {
  const int test = b_.add("test", "toy.source");
  const int features = b_.add("features", "toy.map", {test});
  const int training = b_.add("training", "toy.source");
  const int model = b_.add("model", "toy.train", {training});
  const int apply = b_.add("apply", "toy.join", {features, model});
  const Plan plan = make_plan(b_.graph);
  ASSERT_EQ(plan.units.size(), 3u);
  EXPECT_EQ(plan.units[0].domain, training);
  EXPECT_EQ(plan.units[2].domain, test);
  EXPECT_EQ(plan.units[2].nodes, (std::vector<int>{features, apply}));
}

TEST_F(PlanTest, TwoDomainsThatCollectEachOther) {
  const int d = b_.add("d", "toy.source");
  const int e = b_.add("e", "toy.source");
  const int x = b_.add("x", "toy.map", {d});
  const int y = b_.add("y", "toy.map", {e});
  const int z = b_.add("z", "toy.apply", {b_.add("c", "toy.constant"), y, d});
  const int w = b_.add("w", "toy.apply", {b_.add("c", "toy.constant"), x, e});
  const Plan plan = make_plan(b_.graph);
  std::size_t sweeps = 0;
  for (const auto& unit : plan.units) sweeps += unit.domain >= 0;
  EXPECT_EQ(sweeps, 3u);  // one of the two is swept twice
  EXPECT_NE(plan.unit[static_cast<std::size_t>(z)], plan.unit[static_cast<std::size_t>(w)]);
}

// a - b, and from b on two ways: c - d, and e; f joins them, g follows.
TEST_F(PlanTest, NodesInALineMakeARun) {
  const int source = b_.add("source", "toy.source");
  const int a = b_.add("a", "toy.map", {source});
  const int b = b_.add("b", "toy.map", {a});
  const int c = b_.add("c", "toy.map", {b});
  const int d = b_.add("d", "toy.map", {c});
  const int e = b_.add("e", "toy.map", {b});
  const int f = b_.add("f", "toy.join", {d, e, source});
  const int g = b_.add("g", "toy.map", {f});
  const Plan plan = make_plan(b_.graph);
  const auto& runs = plan.units.at(0).runs;
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_EQ(runs[0].nodes, (std::vector<int>{a, b}));
  EXPECT_EQ(runs[1].nodes, (std::vector<int>{c, d}));
  EXPECT_EQ(runs[2].nodes, (std::vector<int>{e}));
  EXPECT_EQ(runs[3].nodes, (std::vector<int>{f, g}));
  EXPECT_TRUE(runs[0].after.empty());
  EXPECT_EQ(runs[1].after, (std::vector<int>{0}));
  EXPECT_EQ(runs[3].after, (std::vector<int>{1, 2}));
}

}  // namespace
}  // namespace talkgraph
