#include "nodes/speech/place.h"

#include <gtest/gtest.h>

#include <cmath>

namespace talkgraph {
namespace {

TEST(PlaceInRecording, ByHand) {
  const Track place = PlaceInRecording{0.5, 3}({{"sil", "b", "breath", "sil"}, 25});
  Eigen::MatrixXd expected(4, 2);
  expected << 1, std::exp(-0.12), std::exp(-0.08), std::exp(-0.04), std::exp(-0.16), 1, std::exp(-0.24), 1;
  EXPECT_TRUE(place.values.isApprox(3 * expected, 1e-12));
  EXPECT_EQ(place.rate, Rational(25));
  EXPECT_EQ(place.start, 0.02);
}

TEST(PlaceInRecording, WhereNobodySpeaksCountsToTheEnd) {
  const Track place = PlaceInRecording{0.5}({{"sil", "sil", "sil", "sil"}, 25});
  EXPECT_NEAR(place.values(0, 1), std::exp(-0.28), 1e-12);
  EXPECT_EQ(PlaceInRecording{}({{}, 25}).frames(), 0);
  EXPECT_TRUE(PlaceInRecording{}({{"b"}, 25}).values.allFinite());
}

TEST(PlaceInRecording, OfAnyTrackIsItsDistanceInTimeFromBothEnds) {
  Track like;
  like.values.resize(4, 1);
  like.start = 1.02;
  const Eigen::MatrixXd p = places(like, 1.1, 0.5);
  Eigen::MatrixXd expected(4, 2);
  expected << 1, std::exp(-0.16), std::exp(-0.08), std::exp(-0.08), std::exp(-0.16), 1, std::exp(-0.24), 1;
  EXPECT_LT((p - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace talkgraph
