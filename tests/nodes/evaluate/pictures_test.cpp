#include "nodes/evaluate/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "graph/random.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

constexpr int frames = 6;
const cv::Rect lips(40, 60, 20, 10);

std::vector<cv::Mat> recorded_frames() {
  Random random(1);
  std::vector<cv::Mat> all;
  for (int t = 0; t < frames; ++t) {
    cv::Mat frame(100, 100, CV_8UC3);
    for (auto& v : cv::Mat_<cv::Vec3b>(frame))
      for (int k = 0; k < 3; ++k) v[k] = static_cast<unsigned char>(100 + random.below(40));
    all.push_back(frame);
  }
  return all;
}

/// Points 0 to 3 are the face's corners, 4 to 7 those of the mouth, 8 to 11 the inner lips'.
LandmarkTrack points() {
  Shape shape(12, 2);
  shape << 20, 20, 80, 20, 80, 80, 20, 80, 35, 55, 65, 55, 65, 75, 35, 75, 40, 60, 59, 60, 59, 69, 40, 69;
  return {std::vector<Shape>(frames, shape), Rational(25), ""};
}

const ComparePictures node{{4, 5, 6, 7}, {8, 9, 10, 11}};

Video video(const std::vector<cv::Mat>& all) { return video_from_frames(all, Rational(25)); }

std::map<std::string, double> scores(const std::vector<cv::Mat>& drawn) {
  return node(video(recorded_frames()), video(drawn), points())->values;
}

template <class Change>
std::vector<cv::Mat> changed(Change change) {
  auto all = recorded_frames();
  for (auto& frame : all) change(frame);
  return all;
}

TEST(ComparePictures, FindsNoFaultWithTheRecordedOnes) {
  const auto s = scores(recorded_frames());
  EXPECT_EQ(s.at("psnr_face"), 100);
  EXPECT_EQ(s.at("psnr_mouth"), 100);
  EXPECT_NEAR(s.at("ssim_face"), 1, 1e-5);
  EXPECT_NEAR(s.at("ssim_mouth"), 1, 1e-5);
  EXPECT_NEAR(s.at("sharpness"), 1, 1e-9);
  EXPECT_NEAR(s.at("jumps"), 1, 1e-9);
  EXPECT_NEAR(s.at("seam"), 1, 1e-9);
}

TEST(ComparePictures, CountsErrorsWhereTheyLie) {
  const auto s = scores(changed([](cv::Mat& f) { f(cv::Rect(35, 55, 31, 21)) += cv::Scalar::all(5); }));
  EXPECT_NEAR(s.at("psnr_mouth"), 20 * std::log10(255 / 5.0), 1e-6);
  EXPECT_NEAR(s.at("psnr_face"), 20 * std::log10(255 / 5.0) + 10 * std::log10(61.0 * 61 / (31 * 21)), 1e-6);
  EXPECT_LT(s.at("ssim_mouth"), s.at("ssim_face"));
  EXPECT_EQ(scores(changed([](cv::Mat& f) { f.rowRange(0, 19) += cv::Scalar::all(50); })).at("psnr_face"), 100);
}

// Of two flat pictures similarity is (2ab + c) / (a² + b² + c), c = (0.01 · 255)².
TEST(ComparePictures, KnowsTheSimilarityOfFlatPictures) {
  const std::vector<cv::Mat> a(frames, cv::Mat(100, 100, CV_8UC3, cv::Scalar::all(100))),
      b(frames, cv::Mat(100, 100, CV_8UC3, cv::Scalar::all(120)));
  const auto s = node(video(a), video(b), points())->values;
  const double c = 2.55 * 2.55;
  EXPECT_NEAR(s.at("ssim_face"), (2 * 100.0 * 120 + c) / (100.0 * 100 + 120.0 * 120 + c), 1e-4);
  for (const char* ratio : {"sharpness", "jumps", "seam"}) EXPECT_TRUE(std::isnan(s.at(ratio))) << ratio;
}

TEST(ComparePictures, MeasuresSharpnessBetweenTheLips) {
  const auto halved = changed([](cv::Mat& f) { f.convertTo(f, -1, 0.5, 60); });
  EXPECT_NEAR(scores(halved).at("sharpness"), 0.25, 0.02);
  const auto blurred = changed([](cv::Mat& f) { cv::GaussianBlur(f(lips), f(lips), {}, 1); });
  EXPECT_LT(scores(blurred).at("sharpness"), 0.3);
  EXPECT_GT(scores(blurred).at("jumps"), 0.5);
}

TEST(ComparePictures, CountsSharpnessOnlyOfPartedLips) {
  auto shut = points();
  for (auto& shape : shut.frames) shape.bottomRows(4).col(1).setConstant(65);
  EXPECT_TRUE(std::isnan(node(video(recorded_frames()), video(recorded_frames()), shut)->values.at("sharpness")));
}

TEST(ComparePictures, SeesJumpsAndStandstill) {
  EXPECT_EQ(scores(std::vector<cv::Mat>(frames, recorded_frames()[0])).at("jumps"), 0);
  const auto doubled = changed([](cv::Mat& f) { f.convertTo(f, -1, 2, -120); });
  EXPECT_NEAR(scores(doubled).at("jumps"), 2, 0.05);
}

TEST(ComparePictures, SeesAnEdgeAroundTheFace) {
  const auto brighter = changed([](cv::Mat& f) { f(cv::Rect(20, 20, 61, 61)) += cv::Scalar::all(30); });
  EXPECT_GT(scores(brighter).at("seam"), 2);
  EXPECT_NEAR(scores(changed([](cv::Mat& f) { f += cv::Scalar::all(30); })).at("seam"), 1, 1e-6);
}

TEST(ComparePictures, DependsOnTheFaceAlone) {
  const auto framed = [](std::vector<cv::Mat> all) {
    for (auto& f : all) cv::copyMakeBorder(f, f, 70, 90, 50, 110, cv::BORDER_CONSTANT, cv::Scalar(3, 200, 40));
    return video(all);
  };
  const auto blurred = changed([](cv::Mat& f) { cv::GaussianBlur(f, f, {}, 1); });
  auto moved = points();
  for (auto& shape : moved.frames) shape.rowwise() += Eigen::RowVector2d(50, 70);
  const auto in_frame = node(framed(recorded_frames()), framed(blurred), moved)->values;
  for (const auto& [name, value] : scores(blurred)) EXPECT_NEAR(in_frame.at(name), value, 1e-5) << name;
}

TEST(ComparePictures, CountsNothingOfAFaceOutsideThePicture) {
  auto leaves = points();
  leaves.frames[0].array() += 500;
  auto broken = recorded_frames();
  broken[0].setTo(0);
  const auto s = node(video(recorded_frames()), video(broken), leaves)->values;
  EXPECT_EQ(s.at("psnr_face"), 100);
  EXPECT_EQ(s.at("left_out"), 1);
  auto half = points();
  for (auto& shape : half.frames) shape.col(0).array() += 70;  // the mouth is outside
  const auto of_half = node(video(recorded_frames()), video(recorded_frames()), half)->values;
  EXPECT_EQ(of_half.at("psnr_face"), 100);
  EXPECT_TRUE(std::isnan(of_half.at("psnr_mouth")));
  for (auto& shape : leaves.frames) shape.array() += 500;
  EXPECT_FALSE(node(video(recorded_frames()), video(recorded_frames()), leaves));
}

TEST(ComparePictures, LeavesDamagedFramesOut) {
  auto broken = recorded_frames();
  broken[2].setTo(0);
  Video recorded = video(broken);
  recorded.damaged = {2};
  const auto s = node(recorded, video(recorded_frames()), points())->values;
  EXPECT_EQ(s.at("psnr_face"), 100);
  EXPECT_NEAR(s.at("jumps"), 1, 1e-9);
  EXPECT_EQ(s.at("left_out"), 1);
  recorded.damaged = {0, 1, 2, 3, 4, 5};
  EXPECT_FALSE(node(recorded, video(broken), points()));
  EXPECT_FALSE(node(video({}), video({}), {}));
}

TEST(ComparePictures, LeavesOutFramesWithoutLandmarks) {
  auto some = points();
  some.frames[0] = Shape(0, 2);
  auto broken = recorded_frames();
  broken[0].setTo(0);
  const auto s = node(video(recorded_frames()), video(broken), some)->values;
  EXPECT_EQ(s.at("psnr_face"), 100);
  EXPECT_EQ(s.at("left_out"), 1);
}

TEST(ComparePictures, KnowsTheLipsOfAScheme) {
  LandmarkTrack face{std::vector<Shape>(frames, Shape(10 + 0.5 * (find_scheme("ibug68")->mean.array() + 70))),
                     Rational(25), "ibug68"};
  const std::vector<int> outer = {48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59},
                         inner = {60, 61, 62, 63, 64, 65, 66, 67};
  const Video recorded = video(recorded_frames()),
              drawn = video(changed([](cv::Mat&f) { cv::GaussianBlur(f, f, {}, 1); }));
  const auto by_name = ComparePictures{}(recorded, drawn, face)->values,
             by_number = ComparePictures{outer, inner}(recorded, drawn, face)->values;
  for (const char* score : {"psnr_mouth", "ssim_mouth", "jumps"}) EXPECT_EQ(by_name.at(score), by_number.at(score));
}

TEST(ComparePictures, RefusesWhatCannotBeCompared) {
  const Video recorded = video(recorded_frames());
  EXPECT_THROW(node(recorded, video(std::vector<cv::Mat>(frames, cv::Mat(50, 50, CV_8UC3))), points()),
               std::runtime_error);
  EXPECT_THROW(node(recorded, video({recorded_frames()[0]}), points()), std::runtime_error);
  EXPECT_THROW((ComparePictures{{4, 99}, {8}}(recorded, recorded, points())), std::runtime_error);
  EXPECT_THROW(ComparePictures{}(recorded, recorded, points()), std::runtime_error);  // no scheme of 12 points
}

}  // namespace
}  // namespace talkgraph
