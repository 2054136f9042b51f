#include "nodes/face/draw.h"

#include <gtest/gtest.h>

#include "graph/random.h"
#include "nodes/face/geometry.h"
#include "nodes/face/membrane.h"

namespace talkgraph {
namespace {

const Triangles one = (Triangles(1, 3) << 0, 1, 2).finished();

bool holds(const Shape& p, double x, double y, double slack) {
  const auto side = [&](int a, int b) {
    return ((p(b, 0) - p(a, 0)) * (y - p(a, 1)) - (p(b, 1) - p(a, 1)) * (x - p(a, 0))) /
           std::hypot(p(b, 0) - p(a, 0), p(b, 1) - p(a, 1));
  };
  const double a = side(0, 1), b = side(1, 2), c = side(2, 0);
  return (a >= -slack && b >= -slack && c >= -slack) || (a <= slack && b <= slack && c <= slack);
}

TEST(DrawMap, FillsThePixelsOfATriangleAndNoOthers) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    Shape to(3, 2);
    for (auto& v : to.reshaped()) v = round % 3 ? random.uniform(-8, 28) : static_cast<double>(random.below(20));
    cv::Mat map = empty_map({20, 20});
    draw_map(map, to, to, one);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const auto& at = map.at<cv::Vec2f>(y, x);
        if (at[0] == -100) {
          EXPECT_FALSE(holds(to, x, y, -1e-6)) << round << ": " << x << " " << y;
        } else {
          EXPECT_TRUE(holds(to, x, y, 1e-6)) << round << ": " << x << " " << y;
        }
      }
  }
}

// A picture linear in x and y stays so under an affine map, bilinear values being exact.
TEST(DrawTriangles, CarriesALinearPictureOver) {
  cv::Mat texture(30, 40, CV_8UC4);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      texture.at<cv::Vec4b>(y, x) = cv::Vec4b(static_cast<unsigned char>(2 * x + y), static_cast<unsigned char>(5 * x),
                                              static_cast<unsigned char>(250 - 8 * y), 0);
  const Shape from = (Shape(3, 2) << 2, 3, 37, 5, 12, 28).finished(),
              to = (Shape(3, 2) << 10, 10, 90, 20, 30, 75).finished();
  const auto back = affine_maps(to, from, one)[0];
  cv::Mat picture(80, 100, CV_8UC3, cv::Scalar(9, 9, 9));
  draw_triangles(picture, to, texture, from, one);
  int inside = 0;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x) {
      const auto& pixel = picture.at<cv::Vec3b>(y, x);
      if (!holds(to, x, y, -1e-6)) {
        if (!holds(to, x, y, 1e-6)) {
          EXPECT_EQ(pixel, cv::Vec3b(9, 9, 9));
        }
        continue;
      }
      ++inside;
      const double u = back.a * x + back.b * y + back.c, v = back.d * x + back.e * y + back.f;
      EXPECT_NEAR(pixel[0], 2 * u + v, 0.6);
      EXPECT_NEAR(pixel[1], 5 * u, 0.6);
      EXPECT_NEAR(pixel[2], 250 - 8 * v, 0.6);
    }
  EXPECT_GT(inside, 2000);
}

TEST(DrawTriangles, LeavesOutWhatLiesOutsideThePicture) {
  const cv::Mat texture(10, 10, CV_8UC4, cv::Scalar::all(50));
  const Shape from = (Shape(3, 2) << 0, 0, 9, 0, 0, 9).finished();
  cv::Mat picture(20, 20, CV_8UC3, cv::Scalar::all(7));
  draw_triangles(picture, (Shape(3, 2) << -50, -50, -20, -50, -50, -20).finished(), texture, from, one);
  EXPECT_EQ(cv::norm(picture, cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(7)), cv::NORM_INF), 0);
  draw_triangles(picture, (Shape(3, 2) << -500, -500, 1000, -500, -500, 1000).finished(), texture, from, one);
  EXPECT_EQ(cv::norm(picture, cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(50)), cv::NORM_INF), 0);
}

cv::Mat disc(int size) {
  cv::Mat region(size, size, CV_8U, cv::Scalar(0));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) region.at<unsigned char>(y, x) = std::hypot(x - size / 2, y - size / 2) < size / 2;
  return region;
}

// x² − y² and linear functions solve Laplace's equation on the grid exactly.
TEST(Membrane, IsTheHarmonicFieldOfItsBorder) {
  const cv::Mat region = disc(31);
  cv::Mat values(31, 31, CV_32FC3), border = cv::Mat::zeros(31, 31, CV_32FC3);
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x)
      values.at<cv::Vec3f>(y, x) = cv::Vec3f(4, static_cast<float>(3 * x - 2 * y), static_cast<float>(x * x - y * y));
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x) {
      const bool inner = region.at<unsigned char>(y, x) && x > 0 && x < 30 && y > 0 && y < 30 &&
                         region.at<unsigned char>(y, x - 1) && region.at<unsigned char>(y, x + 1) &&
                         region.at<unsigned char>(y - 1, x) && region.at<unsigned char>(y + 1, x);
      border.at<cv::Vec3f>(y, x) = inner ? cv::Vec3f(1e6f, -1e6f, 0) : values.at<cv::Vec3f>(y, x);
    }
  const cv::Mat field = Membrane(region)(border);
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(field.at<cv::Vec3f>(y, x)[k], region.at<unsigned char>(y, x) ? values.at<cv::Vec3f>(y, x)[k] : 0.f,
                    1e-3);
}

TEST(Membrane, TakesRegionsWithoutAnInside) {
  cv::Mat region(5, 5, CV_8U, cv::Scalar(0));
  const cv::Mat values(5, 5, CV_32FC3, cv::Scalar(1, 2, 3));
  EXPECT_EQ(cv::norm(Membrane(region)(values)), 0);
  region.at<unsigned char>(2, 2) = 1;
  EXPECT_EQ(Membrane(region)(values).at<cv::Vec3f>(2, 2), cv::Vec3f(1, 2, 3));
}

}  // namespace
}  // namespace talkgraph
