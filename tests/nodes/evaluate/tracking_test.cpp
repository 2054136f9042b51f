#include "nodes/evaluate/tracking.h"

#include <gtest/gtest.h>

#include <cmath>

namespace talkgraph {
namespace {

FaceTrack track_of(std::vector<Shape> shapes, std::vector<double> confidence) {
  FaceTrack t;
  t.shapes = std::move(shapes);
  for (const double c : confidence) t.lost.push_back(c == 0);
  t.confidence = std::move(confidence);
  return t;
}

Shape square(double x) { return (Shape(4, 2) << x, 0, x + 1, 0, x + 1, 1, x, 1).finished(); }

TEST(ScoreTracking, MeasuresFramesThatAreNotLost) {
  const auto track = track_of({square(0), square(3), square(90)}, {0.8, 0.4, 0});
  const LandmarkTrack given{{square(0), square(7), square(0)}, Rational(25), ""};
  const auto s = ScoreTracking{}(track, &given).values;
  EXPECT_EQ(s.at("frames"), 3);
  EXPECT_EQ(s.at("lost"), 1);
  EXPECT_DOUBLE_EQ(s.at("confidence"), 0.6);
  EXPECT_DOUBLE_EQ(s.at("least_confidence"), 0.4);
  EXPECT_DOUBLE_EQ(s.at("rms"), std::sqrt(8));
  EXPECT_DOUBLE_EQ(s.at("worst"), 4);
}

TEST(ScoreTracking, LeavesOutWhatIsNotGiven) {
  const auto track = track_of({square(0), square(1)}, {0.5, 0.5});
  EXPECT_FALSE(ScoreTracking{}(track, nullptr).values.contains("rms"));
  LandmarkTrack given{{square(0), square(9)}, Rational(25), ""};
  given.frames[1](2, 0) = NAN;
  EXPECT_EQ(ScoreTracking{}(track, &given).values.at("rms"), 0);
  const auto lost = ScoreTracking{}(track_of({square(0), square(1)}, {0, 0}), &given).values;
  EXPECT_EQ(lost.at("lost"), 2);
  EXPECT_FALSE(lost.contains("confidence"));
  EXPECT_FALSE(lost.contains("rms"));
  EXPECT_EQ(ScoreTracking{}({}, nullptr).values.at("frames"), 0);
}

TEST(ScoreTracking, RefusesLandmarksOfAnotherClip) {
  const auto track = track_of({square(0)}, {1});
  const LandmarkTrack fewer{{Shape::Zero(3, 2)}, Rational(25), ""};
  EXPECT_THROW(ScoreTracking{}(track, &fewer), std::runtime_error);
  const LandmarkTrack longer{std::vector<Shape>(4, square(0)), Rational(25), ""};
  EXPECT_THROW(ScoreTracking{}(track, &longer), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
