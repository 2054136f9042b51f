#include "nodes/face/strip.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

Video plain(int frames, cv::Size size, cv::Scalar colour) {
  return video_from_frames(std::vector<cv::Mat>(static_cast<std::size_t>(frames), cv::Mat(size, CV_8UC3, colour)),
                           Rational(25));
}

class Strip : public testing::Test {
 protected:
  Strip() {
    context.folder = folder.path();
    context.item = "utterance";
  }
  cv::Mat picture(const FrameStrip& strip, const Video& video, const Video* below, const FrameLabels* labels) {
    const auto made = strip(video, below, labels, context);
    EXPECT_EQ(made.path, "strips/utterance.png");
    return cv::imread((context.folder / made.path).string());
  }

  const test::TemporaryFolder folder;
  Context context;
};

const cv::Vec3b red(0, 0, 200), blue(200, 0, 0);

TEST_F(Strip, WrapsRowsOfPictures) {
  const cv::Mat sheet = picture({1, 3, 40}, plain(4, {80, 60}, cv::Scalar(red)), nullptr, nullptr);
  ASSERT_EQ(sheet.size(), cv::Size(3 * 42, 2 * (30 + 36)));
  EXPECT_EQ(sheet.at<cv::Vec3b>(29, 2 * 42 + 39), red);
  EXPECT_EQ(sheet.at<cv::Vec3b>(66 + 29, 39), red);
  EXPECT_EQ(sheet.at<cv::Vec3b>(66 + 29, 42), cv::Vec3b(255, 255, 255));
}

TEST_F(Strip, HasTheSecondClipBelowTheFirstAsFarAsBothGo) {
  const Video below = plain(2, {40, 20}, cv::Scalar(blue));
  const cv::Mat sheet = picture({1, 10, 40}, plain(3, {80, 60}, cv::Scalar(red)), &below, nullptr);
  ASSERT_EQ(sheet.size(), cv::Size(22 + 2 * 42, 30 + 20 + 36));
  EXPECT_EQ(sheet.at<cv::Vec3b>(29, 22), red);
  EXPECT_EQ(sheet.at<cv::Vec3b>(30, 22), blue);
  EXPECT_LT(cv::mean(sheet(cv::Rect(0, 0, 22, 30)))[0], 255);
}

// The line over a phone is unbroken while it lasts, and broken between phones and where frames have none.
TEST_F(Strip, DrawsALineAsLongAsThePhoneLasts) {
  const FrameLabels labels{{"aa", "aa", "t"}, Rational(25)};
  const cv::Mat sheet = picture({1, 10, 40}, plain(4, {80, 60}, cv::Scalar(red)), nullptr, &labels);
  const auto black = [&](int x) { return sheet.at<cv::Vec3b>(30 + 16, x) == cv::Vec3b(0, 0, 0); };
  EXPECT_TRUE(black(3) && black(41) && black(42 + 36));
  EXPECT_FALSE(black(42 + 40));
  EXPECT_TRUE(black(2 * 42 + 20));
  EXPECT_FALSE(black(3 * 42 + 20));
}

TEST_F(Strip, ShowsOneFrameOfSoMany) {
  EXPECT_EQ(picture({2, 10, 40}, plain(5, {80, 60}, cv::Scalar(red)), nullptr, nullptr).cols, 3 * 42);
}

TEST_F(Strip, RefusesClipsWithoutFrames) {
  const Video none = video_from_frames({}, Rational(25)), some = plain(1, {80, 60}, cv::Scalar(red));
  EXPECT_THROW(FrameStrip{}(none, nullptr, nullptr, context), std::runtime_error);
  EXPECT_THROW(FrameStrip{}(some, &none, nullptr, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
