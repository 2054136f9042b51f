#include "nodes/smooth/full_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace talkgraph {
namespace {

Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  return t;
}

Mask speech_at(std::vector<std::int64_t> frames) { return {std::move(frames)}; }

TEST(FullRange, ByHand) {
  // Mean 3, variance 4 in speech; 12 are missing: the gain is (16 / 4)^(1/2) = 2.
  const Track in = track((Eigen::VectorXd(6) << 9, 9, 1, 5, 9, 9).finished());
  const Track variance = track((Eigen::VectorXd(6) << 99, 99, 8, 16, 99, 99).finished());
  const Mask speech = speech_at({0, 0, 1, 1, 0, 0});
  const Track out = FullRange{.strength = 1, .fade = 1}(in, variance, speech);
  EXPECT_LT((out.values - (Eigen::VectorXd(6) << 9, 12, -1, 7, 12, 9).finished()).norm(), 1e-12);
  EXPECT_EQ((FullRange{.strength = 0}(in, variance, speech).values), in.values);
  const Track half = FullRange{.strength = 0.5, .fade = 0}(in, variance, speech);
  EXPECT_NEAR(half.values(3, 0), 3 + 2 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(half.values(1, 0), 9);
}

TEST(FullRange, EachParameterByItsOwnVariance) {
  const Track in = track((Eigen::MatrixXd(2, 2) << 1, 1, -1, -1).finished());
  const Track variance = track((Eigen::MatrixXd(2, 2) << 3, 0, 3, 0).finished());
  const Track out = FullRange{.strength = 1}(in, variance, speech_at({1, 1}));
  EXPECT_LT((out.values - (Eigen::MatrixXd(2, 2) << 2, 1, -2, -1).finished()).norm(), 1e-12);
}

TEST(FullRange, LeavesAloneWhatDoesNotMoveOrSpeak) {
  const Track still = track(Eigen::MatrixXd::Constant(4, 1, 0.1)), variance = track(Eigen::MatrixXd::Ones(4, 1));
  EXPECT_EQ((FullRange{}(still, variance, speech_at({1, 1, 1, 1})).values), still.values);
  const Track moving = track((Eigen::VectorXd(4) << 1, 2, 3, 4).finished());
  EXPECT_EQ((FullRange{}(moving, variance, speech_at({0, 0, 0, 0})).values), moving.values);
  EXPECT_EQ((FullRange{}(track(Eigen::MatrixXd(0, 3)), track(Eigen::MatrixXd(0, 3)), {}).frames()), 0);
}

TEST(FullRange, SaysWhatDoesNotAgree) {
  const Track in = track(Eigen::MatrixXd::Random(4, 2)), variance = track(Eigen::MatrixXd::Ones(4, 2));
  const Mask speech = speech_at({1, 1, 1, 1});
  EXPECT_THROW(FullRange{}(in, track(Eigen::MatrixXd::Ones(4, 1)), speech), std::runtime_error);
  EXPECT_THROW(FullRange{}(in, track(Eigen::MatrixXd::Ones(3, 2)), speech), std::runtime_error);
  EXPECT_THROW(FullRange{}(in, variance, speech_at({1})), std::runtime_error);
  EXPECT_THROW(FullRange{}(in, track(Eigen::MatrixXd::Constant(4, 2, -1)), speech), std::runtime_error);
  Track broken = in;
  broken.values(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FullRange{}(broken, variance, speech), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
