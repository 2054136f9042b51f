#include "nodes/sync/shift.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace talkgraph {
namespace {

Track steps() {
  Track t;
  t.values.resize(5, 2);
  t.values << 0, 1, 10, 1, 20, 1, 30, 1, 40, 1;
  t.start = 0.02;
  return t;
}

Table offsets() { return {"", "utterance", {"late, s"}, {"a", "b"}, {{0.02}, {-0.04}}}; }

Track moved(const Track& track, const std::string& key, const Table& table) {
  Context context;
  context.item = key;
  return Shift{}(track, table, context);
}

TEST(Shift, ByHand) {
  EXPECT_EQ(shifted(steps(), 0.25).values.col(0), (Eigen::VectorXd(5) << 2.5, 12.5, 22.5, 32.5, 40).finished());
  EXPECT_EQ(shifted(steps(), -1).values.col(0), (Eigen::VectorXd(5) << 0, 0, 10, 20, 30).finished());
  EXPECT_EQ(shifted(steps(), 9).values.col(0), Eigen::VectorXd::Constant(5, 40));
  EXPECT_EQ(shifted(steps(), 0).values, steps().values);
  EXPECT_EQ(shifted(Track{}, 1).frames(), 0);
}

TEST(Shift, TakesTheUtterancesOwn) {
  EXPECT_EQ(moved(steps(), "a", offsets()).values, shifted(steps(), 0.5).values);
  EXPECT_EQ(moved(steps(), "b", offsets()).values, shifted(steps(), -1).values);
  EXPECT_DOUBLE_EQ(moved(steps(), "a", offsets()).start, 0.02);
}

TEST(Shift, MovesLostFramesToo) {
  Track track = steps();
  track.lost = {2};
  EXPECT_EQ(shifted(track, 0.5).lost, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(shifted(track, 1).lost, (std::vector<std::int64_t>{1}));
  EXPECT_EQ(shifted(track, -1).lost, (std::vector<std::int64_t>{3}));
}

TEST(Shift, SaysWhichTableItNeeds) {
  EXPECT_THROW(moved(steps(), "c", offsets()), std::runtime_error);
  Table other = offsets();
  other.columns = {"lag"};
  EXPECT_THROW(moved(steps(), "a", other), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
