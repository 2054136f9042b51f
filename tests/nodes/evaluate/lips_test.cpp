#include <gtest/gtest.h>

#include <cmath>

#include "graph/random.h"
#include "nodes/evaluate/derivative_warping.h"
#include "nodes/evaluate/lip_movement.h"

namespace talkgraph {
namespace {

constexpr Eigen::Index kMouthLeft = 48, kMouthRight = 54, kInnerBottom = 66, kLips = 20;

/// A mouth 4 wide in every frame, whose inner lips are gaps[t] apart; the last 20 of the 68 points are the lips.
LandmarkTrack mouth(const std::vector<double>& gaps) {
  LandmarkTrack landmarks;
  for (const double gap : gaps) {
    Shape shape = Shape::Zero(68, 2);
    shape(kInnerBottom, 1) = gap;
    shape(kMouthRight, 0) = 4;
    landmarks.frames.push_back(shape);
  }
  return landmarks;
}

Mask speech(std::vector<std::int64_t> frames) { return {std::move(frames)}; }

TEST(LipMovement, AgreesWithValuesByHand) {
  const LandmarkTrack truth = mouth({0, 1, 2, 3, 3});
  LandmarkTrack said = mouth({0.5, 1, 4, 3, 3.5});
  said.frames[3](kMouthLeft, 0) = -1;
  auto s = LipMovement{}(truth, said, speech({0, 1, 1, 1, 0}))->values;
  EXPECT_NEAR(s["lmd"], (0 + 2 + 1) / 3.0 / kLips, 1e-12);
  EXPECT_NEAR(s["lve"], (0 + 2 + 1) / 3.0, 1e-12);
  // Frames 1 to 2: the lip moves 3, not 1. Frames 2 to 3: −1, not 1, and a corner moves by 1.
  EXPECT_NEAR(s["lmvd"], (2 + 3) / 2.0 / kLips, 1e-12);
  EXPECT_NEAR(s["gap_range"], std::sqrt((1 + 16 + 9) / 3.0 - 64 / 9.0) / std::sqrt(2 / 3.0), 1e-12);
  EXPECT_FALSE(s.contains("silent")) << "no two such frames are neighbours";
}

TEST(LipMovement, OfTheTruthIsNoError) {
  const LandmarkTrack truth = mouth({0, 1, 3, 2, 2, 2.5});
  auto s = LipMovement{}(truth, truth, speech({1, 1, 1, 1, 0, 0}))->values;
  for (const char* error : {"lmd", "lmvd", "lve", "ddtw"}) EXPECT_EQ(s[error], 0) << error;
  EXPECT_DOUBLE_EQ(s["gap_range"], 1);
  EXPECT_NEAR(s["silent"], 0.5 / kLips, 1e-12);
}

TEST(LipMovement, SilentLipsMayTremble) {
  const LandmarkTrack truth = mouth({1, 1, 1, 2, 2}), said = mouth({1, 1.25, 1, 2, 2});
  auto s = LipMovement{}(truth, said, speech({0, 0, 0, 1, 1}))->values;
  EXPECT_NEAR(s["silent"], 0.25 / kLips, 1e-12) << "only steps among silent frames count";
  s = LipMovement{}(truth, said, speech({0, 0, 0, 0, 0}))->values;
  EXPECT_EQ(s.size(), 1U);
  EXPECT_NEAR(s["silent"], (0.25 + 0.25 + 1 + 0) / 4 / kLips, 1e-12);
}

TEST(LipMovement, MeasuresInMouthWidths) {
  const LandmarkTrack truth = mouth({0, 1, 2, 3}), said = mouth({1, 1, 3, 2});
  const Mask all = speech({1, 1, 1, 1});
  LipMovement node;
  auto pixels = node(truth, said, all)->values;
  node.unit = {"mouth_left", "mouth_right"};
  auto widths = node(truth, said, all)->values;
  for (const char* length : {"lmd", "lmvd", "lve", "ddtw"}) EXPECT_NEAR(widths[length], pixels[length] / 4, 1e-12);
  EXPECT_EQ(widths["gap_range"], pixels["gap_range"]);
  node.unit = {"mouth_left", "mouth_top"};
  EXPECT_THROW(node(truth, said, all), std::runtime_error) << "one point";
  node.unit = {"mouth_left"};
  EXPECT_THROW(node(truth, said, all), std::runtime_error);
}

TEST(LipMovement, LeavesOutFramesWithoutLandmarks) {
  LandmarkTrack truth = mouth({0, 9, 1, 2}), said = mouth({0, 1, 1, 2.5});
  truth.frames[1].setConstant(NAN);
  auto s = LipMovement{}(truth, said, speech({1, 1, 1, 1}))->values;
  EXPECT_NEAR(s["lve"], 0.5 / 3, 1e-12);
  EXPECT_NEAR(s["lmvd"], 0.5 / kLips, 1e-12) << "no step leads over the frame";
  for (Shape& frame : said.frames) frame.setConstant(NAN);
  EXPECT_FALSE(LipMovement{}(truth, said, speech({1, 1, 1, 1})));
  EXPECT_FALSE(LipMovement{}(mouth({}), mouth({}), speech({})));
}

TEST(LipMovement, RefusesWhatDoesNotFit) {
  const LandmarkTrack truth = mouth({0, 1, 2, 3, 4});
  EXPECT_THROW(LipMovement{}(truth, mouth({0, 1}), speech({1, 1, 1, 1, 1})), std::runtime_error);
  EXPECT_THROW(LipMovement{}(truth, truth, speech({1, 1})), std::runtime_error);
  EXPECT_NO_THROW(LipMovement{}(truth, mouth({0, 1, 2}), speech({1, 1, 1})));
  EXPECT_THROW((LipMovement{.points = {"beard"}}(truth, truth, speech({1, 1, 1, 1, 1}))), std::runtime_error);
  EXPECT_THROW((LipMovement{.points = {}}(truth, truth, speech({1, 1, 1, 1, 1}))), std::runtime_error);
  LandmarkTrack other;
  other.frames.assign(5, Shape::Zero(20, 2));
  EXPECT_THROW(LipMovement{}(truth, other, speech({1, 1, 1, 1, 1})), std::runtime_error);
}

Eigen::VectorXd wave(Eigen::Index n, double phase) {
  return Eigen::VectorXd::NullaryExpr(n,
                                      [&](Eigen::Index t) { return std::sin(0.4 * static_cast<double>(t) + phase); });
}

/// The least sum of squares over all warping paths, and the number of pairs, by trying them all.
std::pair<double, int> least(const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::Index i, Eigen::Index j,
                             Eigen::Index window) {
  if (i < 0 || j < 0 || std::abs(i - j) > window) return {INFINITY, 0};
  std::pair<double, int> before{i + j == 0 ? 0 : INFINITY, 0};
  for (const auto& [di, dj] : {std::pair{1, 1}, {1, 0}, {0, 1}})
    if (const auto way = least(u, v, i - di, j - dj, window); way.first < before.first) before = way;
  return {before.first + std::pow(u(i) - v(j), 2), before.second + 1};
}

TEST(DerivativeWarping, HasTheSlopesOfItsAuthors) {
  EXPECT_TRUE(warping_slopes(Eigen::Vector4d(1, 2, 4, 0)).isApprox(Eigen::Vector2d(1.25, 0.5)));
  EXPECT_EQ(warping_slopes(Eigen::Vector2d(1, 2)).size(), 0);
}

TEST(DerivativeWarping, FindsTheBestOfAllPaths) {
  Random random(3);
  for (const Eigen::Index window : {0, 2, 7})
    for (int draw = 0; draw < 20; ++draw) {
      const Eigen::VectorXd a = Eigen::VectorXd::NullaryExpr(9, [&] { return random.normal(); }),
                            b = Eigen::VectorXd::NullaryExpr(9, [&] { return random.normal(); });
      const auto [sum, pairs] = least(warping_slopes(a), warping_slopes(b), 6, 6, window);
      EXPECT_NEAR(derivative_warping(a, b, window), std::sqrt(sum / pairs), 1e-12);
    }
}

TEST(DerivativeWarping, ForgivesDelaysAndOffsets) {
  const Eigen::VectorXd a = wave(60, 0), late = wave(60, -0.8), small = 0.3 * a;
  EXPECT_EQ(derivative_warping(a, a, 10), 0);
  EXPECT_NEAR(derivative_warping(a, a.array() + 5, 10), 0, 1e-12);
  EXPECT_LT(derivative_warping(a, late, 10), 0.3 * derivative_warping(a, late, 0));
  EXPECT_GT(derivative_warping(a, small, 10), derivative_warping(a, late, 10)) << "but not too little movement";
  EXPECT_GE(derivative_warping(a, wave(40, 0), 0), 0) << "lengths may differ";
  EXPECT_TRUE(std::isnan(derivative_warping(a, Eigen::Vector2d(0, 1), 10)));
}

}  // namespace
}  // namespace talkgraph
