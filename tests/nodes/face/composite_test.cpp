#include "nodes/face/composite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "nodes/face/base_clip.h"
#include "nodes/face/build.h"
#include "nodes/face/choose_base.h"
#include "nodes/face/crop.h"
#include "nodes/face/modes.h"
#include "nodes/face/parameters.h"
#include "nodes/face/render.h"
#include "nodes/face/shapes.h"
#include "nodes/face/side_by_side.h"
#include "nodes/face/track.h"
#include "synthetic_face.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using test::model;

Video still(double open, int frames, std::string name = "still") {
  test::SyntheticFace f;
  f.open = open;
  return video_from_frames(std::vector<cv::Mat>(static_cast<std::size_t>(frames), test::draw(f)), Rational(25),
                           std::move(name));
}

Video talking(int frames) {
  std::vector<cv::Mat> all;
  for (int t = 0; t < frames; ++t) all.push_back(test::draw(test::talking_face(t)));
  return video_from_frames(all, Rational(25), "talking");
}

FaceTrack track(const Video& video) {
  Context context;
  return TrackFace{}(model(), video, context);
}

BaseClip base_of(const Video& video) { return MakeBaseClip{}(video, track(video)); }

TEST(CompositeFace, OwnParametersReproduceThePicture) {
  const auto base = base_of(talking(5));
  for (const auto& [part, seam] : {std::pair{FacePart::lower, Seam::feather},
                                   {FacePart::whole, Seam::feather},
                                   {FacePart::lower, Seam::poisson},
                                   {FacePart::whole, Seam::poisson}}) {
    CompositeFace node;
    node.part = part;
    node.seam = seam;
    const auto drawn = node(model(), base.track.parameters, base, nullptr, nullptr).read_all();
    const auto real = base.frames.read_all();
    ASSERT_EQ(drawn.size(), 5u);
    for (std::size_t t = 0; t < 5; ++t) EXPECT_GT(test::psnr(drawn[t], real[t]), 38) << t;
  }
}

TEST(CompositeFace, PutsTheMouthOfOneClipOnAnother) {
  const auto shut = base_of(still(0.1, 2)), open = base_of(still(0.9, 2));
  const auto drawn = CompositeFace{}(model(), open.track.parameters, shut, nullptr, nullptr).read_all();
  const auto wanted = open.frames.read_all(), before = shut.frames.read_all();
  EXPECT_GT(test::psnr(drawn[0], wanted[0]), test::psnr(before[0], wanted[0]) + 8);
  EXPECT_GT(test::psnr(drawn[0], wanted[0]), 32);
}

TEST(CompositeFace, LeavesTheRestOfThePictureAlone) {
  const auto shut = base_of(still(0.1, 1)), open = base_of(still(0.9, 1));
  const auto drawn = CompositeFace{}(model(), open.track.parameters, shut, nullptr, nullptr).read_all()[0];
  const auto before = shut.frames.read_all()[0];
  EXPECT_EQ(cv::norm(drawn.rowRange(0, 15), before.rowRange(0, 15), cv::NORM_INF), 0);
  const cv::Rect eyes(70, 70, 60, 20);
  EXPECT_LE(cv::norm(drawn(eyes), before(eyes), cv::NORM_INF), 2);
}

TEST(CompositeFace, MayLeaveThePicture) {
  auto base = base_of(still(0.1, 1));
  const cv::Mat before = base.frames.read_all()[0];
  cv::Mat drawn;
  for (double x = -before.cols; x <= 2 * before.cols; x += 10) {
    base.track.poses[0].dx = x;
    drawn = CompositeFace{}(model(), base.track.parameters, base, nullptr, nullptr).read_all().at(0);
    ASSERT_EQ(drawn.size(), before.size());
  }
  EXPECT_EQ(cv::norm(drawn, before, cv::NORM_INF), 0);
}

TEST(CompositeFace, RunsAShortBaseBackAndForth) {
  const auto base = base_of(talking(3));
  Track p = base.track.parameters;
  p.values = Eigen::MatrixXd(7, model().modes());
  for (int t = 0; t < 7; ++t)
    p.values.row(t) = base.track.parameters.values.row(std::vector<int>{0, 1, 2, 1, 0, 1, 2}[t]);
  const auto drawn = CompositeFace{}(model(), p, base, nullptr, nullptr).read_all();
  ASSERT_EQ(drawn.size(), 7u);
  EXPECT_EQ(cv::norm(drawn[1], drawn[3], cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(drawn[0], drawn[4], cv::NORM_INF), 0);
}

TEST(CompositeFace, DrawsOnGoodFramesOnly) {
  auto base = base_of(talking(4));
  base.track.lost = {1, 0, 0, 1};
  Track p = base.track.parameters;
  p.values = base.track.parameters.values.middleRows(1, 1).eval();
  EXPECT_GT(test::psnr(CompositeFace{}(model(), p, base, nullptr, nullptr).read_all()[0], base.frames.read_all()[1]),
            38);
  base.track.lost = {1, 1, 1, 1};
  EXPECT_THROW(CompositeFace{}(model(), p, base, nullptr, nullptr), std::runtime_error);
}

TEST(CompositeFace, RefusesParametersOfAnotherModel) {
  const auto base = base_of(talking(1));
  Track p = base.track.parameters;
  p.values.conservativeResize(1, p.values.cols() - 1);
  EXPECT_THROW(CompositeFace{}(model(), p, base, nullptr, nullptr), std::runtime_error);
  p.values = Eigen::MatrixXd::Constant(1, model().modes(), std::nan(""));
  EXPECT_THROW(CompositeFace{}(model(), p, base, nullptr, nullptr), std::runtime_error);
}

TEST(RenderFace, ShowsTheMeanFace) {
  Track p{Eigen::MatrixXd::Zero(2, model().modes()), Rational(25), 0.02, {}};
  const auto video = RenderFace{}(model(), p, nullptr, nullptr);
  const auto frames = video.read_all();
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].size(), video.source->size());
  EXPECT_EQ(frames[0].cols % 2 + frames[0].rows % 2, 0);
  EXPECT_EQ(frames[0].at<cv::Vec3b>(0, 0), cv::Vec3b(128, 128, 128));
  EXPECT_NE(frames[0].at<cv::Vec3b>(frames[0].rows / 2, frames[0].cols / 2), cv::Vec3b(128, 128, 128));
}

TEST(FaceShapes, OpenMouthsAreTallerThanShut) {
  const auto shut = track(still(0.1, 1)), open = track(still(0.9, 1));
  const auto height = [](const FaceTrack& t) {
    const Shape mouth = FaceShapes{}(model(), FaceParameters{}(t)).frames[0].bottomRows(8);
    return mouth.col(1).maxCoeff() - mouth.col(1).minCoeff();
  };
  EXPECT_NEAR(height(open) - height(shut), 45 * 2 * 0.16 * 0.8, 1);
}

TEST(FaceShapes, HasNoLandmarksWhereTheFaceWasLost) {
  Track parameters = FaceParameters{}(track(still(0.1, 2)));
  parameters.lost = {1};
  const LandmarkTrack shapes = FaceShapes{}(model(), parameters);
  EXPECT_TRUE(shapes.frames.at(0).allFinite());
  EXPECT_TRUE(shapes.frames.at(1).array().isNaN().all());
}

/// Tracked clips that ChooseBase is to choose from.
struct Clips {
  Collected<Video> videos;
  Collected<FaceTrack> tracks;
  void add(const std::string& key, const std::vector<std::int64_t>& lost, double residual, double gain = 1000) {
    const auto frames = static_cast<int>(lost.size());
    auto t = track(still(0.5, frames));
    t.lost = lost;
    t.residual.assign(t.lost.size(), residual);
    t.gain.assign(t.lost.size(), gain);
    videos.add(key, still(0.5, frames, key));
    tracks.add(key, t);
  }
  std::string chosen(const ChooseBase& node) const { return node(videos, tracks).frames.source->name(); }
};

TEST(ChooseBase, TakesTheBestFittedOneThatIsLongEnough) {
  Clips clips;
  clips.add("lost", {1, 1, 1}, 1);
  clips.add("short", {0}, 1);
  clips.add("interrupted", {0, 1, 0}, 1);
  clips.add("well", {0, 0, 0}, 2);
  clips.add("badly", {0, 0, 0, 0}, 3);
  clips.videos.add("untracked", still(0.5, 9));
  EXPECT_EQ(clips.chosen({"", 0.12}), "well");
  EXPECT_EQ(clips.chosen({"", 9}), "badly") << "the longest";
  EXPECT_EQ(clips.chosen({"", 0.04}), "short");
  EXPECT_EQ(clips.chosen({"lost"}), "lost");
  EXPECT_THROW(clips.chosen({"none"}), std::runtime_error);
}

TEST(ChooseBase, IsNotDrawnToDimPictures) {
  Clips clips;
  clips.add("dim", {0, 0}, 1, 400);
  clips.add("bright", {0, 0}, 2, 1000);
  EXPECT_EQ(clips.chosen(ChooseBase{}), "bright");
}

TEST(ChooseBase, RefusesNoClip) { EXPECT_THROW(ChooseBase{}({}, {}), std::runtime_error); }

TEST(MakeBaseClip, RefusesUnequalLengths) {
  EXPECT_THROW(MakeBaseClip{}(talking(2), track(talking(1))), std::runtime_error);
}

TEST(SideBySide, HasTheShorterLengthAndEvenSides) {
  const auto small = video_from_frames({cv::Mat(51, 33, CV_8UC3, cv::Scalar(1, 2, 3))}, Rational(25));
  const auto both = SideBySide{}(talking(3), small);
  EXPECT_EQ(both.source->frames(), 1);
  const auto frames = both.read_all();
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].size(), both.source->size());
  EXPECT_EQ(frames[0].cols % 2 + frames[0].rows % 2, 0);
  EXPECT_EQ(frames[0].at<cv::Vec3b>(frames[0].rows - 1, frames[0].cols - 1), cv::Vec3b(1, 2, 3));
  EXPECT_EQ((SideBySide{"", ""}(small, small).source->size()), cv::Size(68, 52));
  EXPECT_NE(both.source->key(), SideBySide{}(talking(2), small).source->key());
  EXPECT_THROW(SideBySide{}(talking(1), video_from_frames({small.read_all()[0]}, Rational(30))), std::runtime_error);
}

LandmarkTrack corners(std::initializer_list<std::pair<double, double>> points) {
  LandmarkTrack track;
  for (const auto& [x, y] : points) track.frames.push_back((Shape(2, 2) << x, y, x + 10, y + 4).finished());
  return track;
}

std::string crop_error(const Video& video, const LandmarkTrack& landmarks, std::vector<int> points = {}) {
  try {
    Crop{std::move(points)}(video, landmarks);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "nothing";
}

TEST(Crop, HoldsThePointsOfEveryFrame) {
  cv::Mat picture(40, 60, CV_8UC3);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) picture.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<uchar>(x), static_cast<uchar>(y));
  Video video = video_from_frames({picture, picture, picture}, Rational(30));
  video.damaged = {1};
  const auto part = Crop{{}, 0.25}(video, corners({{20, 10}, {22, 12}}));
  EXPECT_EQ(part.source->size(), cv::Size(20, 14));  // x from 17 to 35, y from 7 to 19, sides made even
  EXPECT_EQ(part.source->rate(), Rational(30));
  EXPECT_EQ(part.source->frames(), 3);
  EXPECT_EQ(part.damaged, video.damaged);
  const auto frames = part.read_all();
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].at<cv::Vec3b>(0, 0), cv::Vec3b(17, 7));
  EXPECT_EQ((Crop{{1}, 0})(video, corners({{20, 10}, {25, 15}})).read_all()[0].at<cv::Vec3b>(0, 0), cv::Vec3b(30, 14));
  EXPECT_EQ((Crop{{}, 10})(video, corners({{20, 10}})).source->size(), cv::Size(60, 40));
  EXPECT_NE(part.source->key(), video.source->key());
}

TEST(Crop, KnowsPointsByTheirNamesInTheScheme) {
  const auto video = still(0.5, 1);
  LandmarkTrack track{{Shape::Zero(68, 2), Shape::Constant(68, 2, NAN)}, Rational(25), "ibug68"};
  track.frames[0].row(48) << 20, 30;
  track.frames[0].row(54) << 60, 34;
  const Crop by_name{{}, 0, {"mouth_left", "mouth_right"}}, by_number{{48, 54}, 0};
  EXPECT_EQ(by_name(video, track).source->key(), by_number(video, track).source->key());
  EXPECT_EQ(by_name(video, track).source->size(), cv::Size(42, 6));
  EXPECT_THROW((Crop{{}, 0, {"mouth"}}(video, track)), std::runtime_error);
}

TEST(Crop, RefusesWhatHoldsNothing) {
  const auto video = still(0.5, 1);
  EXPECT_THAT(crop_error(video, {}), testing::HasSubstr("still: there are no landmarks"));
  EXPECT_THAT(crop_error(video, corners({{20, 10}}), {2}), testing::HasSubstr("landmarks of 2 points have no point 2"));
  EXPECT_THAT(crop_error(video, corners({{-500, 10}})), testing::HasSubstr("outside the picture"));
}

TEST(FaceModes, AreAPicture) {
  const test::TemporaryFolder folder;
  Context context;
  context.folder = folder.path();
  const auto modes = FaceModes{}(model(), nullptr, context);
  EXPECT_FALSE(cv::imread((context.folder / modes.path).string()).empty());
  context.folder = "/proc/nowhere";
  EXPECT_THROW(FaceModes{}(model(), nullptr, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
