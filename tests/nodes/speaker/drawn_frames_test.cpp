#include "nodes/speaker/drawn_frames.h"

#include <gtest/gtest.h>

namespace talkgraph::face {
namespace {

constexpr Key one{1, 1}, other{2, 2};

/// Room for three frames of a hundred bytes; counts what is drawn.
struct Drawing {
  DrawnFrames frames{300};
  int drawn = 0;

  int operator()(const Key& clip, std::size_t t) {
    const cv::Mat frame = frames.frame(clip, t, [&] {
      ++drawn;
      return cv::Mat(10, 10, CV_8U, cv::Scalar(static_cast<double>(10 * clip.low + t)));
    });
    return frame.at<unsigned char>(9, 9);
  }
};

TEST(DrawnFrames, AreDrawnOnce) {
  Drawing drawing;
  for (int readers = 0; readers < 5; ++readers)
    for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(drawing(one, t), 10 + static_cast<int>(t));
  EXPECT_EQ(drawing.drawn, 3);
}

TEST(DrawnFrames, AreToldApartByClip) {
  Drawing drawing;
  EXPECT_EQ(drawing(one, 0), 10);
  EXPECT_EQ(drawing(other, 0), 20);
  EXPECT_EQ(drawing.drawn, 2);
}

TEST(DrawnFrames, MakeRoomForNewOnesOldestFirst) {
  Drawing drawing;
  for (std::size_t t = 0; t < 4; ++t) drawing(one, t);
  drawing(one, 3);
  drawing(one, 1);
  EXPECT_EQ(drawing.drawn, 4);
  EXPECT_EQ(drawing(one, 0), 10);
  EXPECT_EQ(drawing.drawn, 5);
}

TEST(DrawnFrames, AreNotKeptWhereOneIsTooLarge) {
  DrawnFrames frames(99);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(frames.frame(one, 0, [] { return cv::Mat(10, 10, CV_8U, cv::Scalar(7)); }).at<unsigned char>(0, 0), 7);
}

TEST(DrawnFrames, MayBePaintedOver) {
  Drawing drawing;
  drawing(one, 0);
  drawing.frames.frame(one, 0, [] { return cv::Mat(); }).setTo(0);
  EXPECT_EQ(drawing(one, 0), 10);
  EXPECT_EQ(drawing.drawn, 1);
}

}  // namespace
}  // namespace talkgraph::face
