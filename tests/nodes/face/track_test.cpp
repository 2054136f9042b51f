#include "nodes/face/track.h"

#include <gtest/gtest.h>

#include "nodes/face/build.h"
#include "nodes/face/landmarks.h"
#include "nodes/face/parameters.h"
#include "synthetic_face.h"

namespace talkgraph {
namespace {

using test::model;

FaceTrack track(const Video& video, TrackFace node = {}) {
  Context context;
  return node(model(), video, context);
}

std::vector<cv::Mat> talking(int frames) {
  std::vector<cv::Mat> all;
  for (int t = 0; t < frames; ++t) all.push_back(test::draw(test::talking_face(t)));
  return all;
}

class TrackBy : public testing::TestWithParam<FitMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, TrackBy,
                         testing::Values(FitMethod::fixed_jacobian, FitMethod::inverse_compositional));

TEST_P(TrackBy, FollowsATalkingFace) {
  TrackFace node;
  node.fitter = GetParam();
  const auto t = track(video_from_frames(talking(20), Rational(25)), node);
  ASSERT_EQ(t.shapes.size(), 20u);
  EXPECT_EQ(t.parameters.frames(), 20);
  EXPECT_DOUBLE_EQ(t.parameters.start, 0.02);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(t.lost[i], 0) << i;
    EXPECT_GT(t.confidence[i], 0.5) << i;
    EXPECT_LT(test::rms_distance(t.shapes[i], test::landmarks(test::talking_face(i))), 0.5) << i;
  }
}

TEST(TrackFace, BridgesADamagedFrame) {
  auto frames = talking(9);
  frames[4].setTo(cv::Scalar(128, 128, 128));
  auto video = video_from_frames(frames, Rational(25));
  for (const bool declared : {false, true}) {
    if (declared) video.damaged = {4};
    const auto t = track(video);
    EXPECT_EQ(t.lost, (std::vector<std::int64_t>{0, 0, 0, 0, 1, 0, 0, 0, 0}));
    EXPECT_LT((t.parameters.values.row(4) - 0.5 * (t.parameters.values.row(3) + t.parameters.values.row(5))).norm(),
              1e-12);
    EXPECT_EQ(t.confidence[4], 0);
    EXPECT_NEAR(t.poses[4].dx, 0.5 * (t.poses[3].dx + t.poses[5].dx), 1e-12);
  }
}

TEST(FaceTrack, GivesItsParametersWithLostFramesAndLandmarksOfTheOthers) {
  auto frames = talking(4);
  frames[2].setTo(cv::Scalar(128, 128, 128));
  const auto t = track(video_from_frames(frames, Rational(25)));
  EXPECT_EQ(FaceParameters{}(t).lost, (std::vector<std::int64_t>{2}));
  EXPECT_EQ(FaceParameters{}(t).values, t.parameters.values);
  const auto landmarks = FaceLandmarks{}(t, &model());
  EXPECT_EQ(landmarks.rate, Rational(25));
  ASSERT_EQ(landmarks.frames.size(), 4u);
  EXPECT_EQ(landmarks.frames[3], t.shapes[3]);
  EXPECT_EQ(landmarks.frames[2].rows(), t.shapes[2].rows());
  EXPECT_TRUE(landmarks.frames[2].array().isNaN().all()) << "the face was lost there";
  EXPECT_EQ(landmarks.scheme, "synthetic");
  EXPECT_EQ(FaceLandmarks{}(t, nullptr).scheme, "");
}

TEST(TrackFace, CopiesIntoLostEnds) {
  auto frames = talking(6);
  for (const int i : {0, 1, 5}) frames[i].setTo(cv::Scalar::all(90));
  const auto t = track(video_from_frames(frames, Rational(25)));
  EXPECT_EQ(t.lost, (std::vector<std::int64_t>{1, 1, 0, 0, 0, 1}));
  EXPECT_EQ(t.parameters.values.row(0), t.parameters.values.row(2));
  EXPECT_EQ(t.parameters.values.row(1), t.parameters.values.row(2));
  EXPECT_EQ(t.parameters.values.row(5), t.parameters.values.row(4));
}

TEST(TrackFace, FindsTheFaceAgainAfterACut) {
  auto frames = talking(4);
  auto moved = test::talking_face(4);
  moved.x -= 40;
  moved.y += 25;
  frames.push_back(test::draw(moved));
  const auto t = track(video_from_frames(frames, Rational(25)));
  EXPECT_EQ(t.lost.back(), 0);
  EXPECT_LT(test::rms_distance(t.shapes.back(), test::landmarks(moved)), 0.5);
}

TEST(TrackFace, TriesADoubtfulFitFromBeside) {
  test::SyntheticFace face;
  face.open = 0.3;
  face.x = 64;
  std::vector<cv::Mat> frames = {test::draw(face)};
  face.x = 30;  // the picture ends in the cheek
  frames.push_back(test::draw(face));
  const auto distance = [&](double reach) {
    TrackFace node;
    node.reach = reach;
    return test::rms_distance(track(video_from_frames(frames, Rational(25)), node).shapes[1], test::landmarks(face));
  };
  EXPECT_LT(distance(0.5), 0.75 * distance(0));
}

TEST(TrackFace, OneFrame) {
  const auto t = track(video_from_frames(talking(1), Rational(30000, 1001)));
  ASSERT_EQ(t.lost, std::vector<std::int64_t>{0});
  EXPECT_NEAR(t.parameters.start, 0.5 * 1001 / 30000, 1e-12);
  EXPECT_LT(test::rms_distance(t.shapes[0], test::landmarks(test::talking_face(0))), 0.5);
}

TEST(TrackFace, NoFaceIsLostNotAnError) {
  for (const auto& colour : {cv::Scalar(50, 60, 70), cv::Scalar(110, 140, 190), cv::Scalar::all(0)}) {
    const std::vector<cv::Mat> flat(3, cv::Mat(120, 160, CV_8UC3, colour));
    const auto t = track(video_from_frames(flat, Rational(25)));
    EXPECT_EQ(t.lost, (std::vector<std::int64_t>{1, 1, 1})) << colour;
    EXPECT_EQ(t.parameters.values.norm(), 0);
    EXPECT_TRUE(t.shapes[0].allFinite());
  }
}

TEST(TrackFace, APictureSmallerThanTheFaceIsLost) {
  const std::vector<cv::Mat> tiny(1, cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3)));
  EXPECT_EQ(track(video_from_frames(tiny, Rational(25))).lost, std::vector<std::int64_t>{1});
}

TEST(TrackFace, RefusesAClipWithoutFrames) {
  EXPECT_THROW(track(video_from_frames({}, Rational(25))), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
