#include "nodes/write/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class WritesLandmarks : public testing::Test {
 protected:
  void SetUp() override {
    context.folder = folder.path();
    points << 0, 0, 10.5, 1.0 / 3, -2, 7;
  }
  template <class Node, class T>
  std::string complaint(const Node& node, const T& value) {
    try {
      node(value, context);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "none";
  }

  const test::TemporaryFolder folder;
  Context context;
  Shape points = Shape(3, 2);
};

const char* const kText = "version: 1\nn_points: 3\n{\n1 1\n11.5 1.3333333333333333\n-1 8\n}\n";

TEST_F(WritesLandmarks, OneFileAFrame) {
  context.item = "s1/a";
  EXPECT_EQ(WriteLandmarks{}({{points, points + Shape::Ones(3, 2), points}, 25, "three"}, context).path,
            "landmarks/s1/a");
  EXPECT_EQ(folder.read("landmarks/s1/a/000000.pts"), kText);
  EXPECT_THAT(folder.read("landmarks/s1/a/000001.pts"), HasSubstr("{\n2 2\n"));
  EXPECT_EQ(folder.read("landmarks/s1/a/000002.pts"), kText);
}

TEST_F(WritesLandmarks, NoFileOfAFrameWithoutLandmarks) {
  const Shape none = Shape::Constant(3, 2, NAN);
  WriteLandmarks{}({{none, points, none}, 25, ""}, context);
  EXPECT_EQ(folder.read("landmarks/landmarks/000001.pts"), kText);
  for (const char* file : {"000000.pts", "000002.pts"})
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "landmarks/landmarks" / file)) << file;
  EXPECT_THAT(complaint(WriteLandmarks{}, LandmarkTrack{{none, none}, 25, ""}), HasSubstr("no frame"));
}

TEST_F(WritesLandmarks, OnlyWhatTheFormatCanSay) {
  EXPECT_THAT(complaint(WriteLandmarks{}, LandmarkTrack{}), HasSubstr("no frame"));
  points(1, 0) = NAN;
  EXPECT_THAT(complaint(WriteLandmarks{}, LandmarkTrack{{points}, 25, ""}),
              HasSubstr("landmarks/landmarks/000000.pts: point 1 is missing"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "landmarks/landmarks/000000.pts"));
}

TEST_F(WritesLandmarks, PicturesBesideTheirs) {
  const cv::Mat pixels(4, 6, CV_8UC3, cv::Scalar(10, 20, 30));
  EXPECT_EQ(WritePrototypes{"out"}({{{pixels}}, {points}, "three"}, context).path, "out");
  EXPECT_EQ(folder.read("out/000000.pts"), kText);
  const cv::Mat back = cv::imread(folder.file("out/000000.png"));
  EXPECT_EQ(back.size(), pixels.size());
  EXPECT_EQ(back.at<cv::Vec3b>(3, 5), cv::Vec3b(10, 20, 30));
  EXPECT_THAT(complaint(WritePrototypes{"none"}, Prototypes{{{cv::Mat()}}, {points}, ""}), HasSubstr("000000.png"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "none"));
}

}  // namespace
}  // namespace talkgraph
