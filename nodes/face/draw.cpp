#include "nodes/face/draw.h"

#include <algorithm>
#include <cmath>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

struct Line {
  double a, b, c;  ///< a x + b y + c is not negative on the inner side
};

Line inner_side(const Shape& p, int from, int to, int apex) {
  Line l{p(from, 1) - p(to, 1), p(to, 0) - p(from, 0), 0};
  l.c = -(l.a * p(from, 0) + l.b * p(from, 1));
  if (l.a * p(apex, 0) + l.b * p(apex, 1) + l.c < 0) l = {-l.a, -l.b, -l.c};
  return l;
}

}  // namespace

void draw_map(cv::Mat& map, const Shape& to, const Shape& from, const Triangles& triangles) {
  const auto maps = affine_maps(to, from, triangles);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const int i = triangles(t, 0), j = triangles(t, 1), k = triangles(t, 2);
    const auto [x_low, x_high] = std::minmax({to(i, 0), to(j, 0), to(k, 0)});
    const auto [y_low, y_high] = std::minmax({to(i, 1), to(j, 1), to(k, 1)});
    const int x0 = std::max(0, static_cast<int>(std::ceil(x_low))),
              x1 = std::min(map.cols - 1, static_cast<int>(std::floor(x_high)));
    const int y0 = std::max(0, static_cast<int>(std::ceil(y_low))),
              y1 = std::min(map.rows - 1, static_cast<int>(std::floor(y_high)));
    const Line sides[3] = {inner_side(to, i, j, k), inner_side(to, j, k, i), inner_side(to, k, i, j)};
    const Affine& m = maps[static_cast<std::size_t>(t)];
    for (int y = y0; y <= y1; ++y) {
      auto* row = map.ptr<cv::Vec2f>(y);
      for (int x = x0; x <= x1; ++x) {
        if (std::any_of(sides, sides + 3, [&](const Line& l) { return l.a * x + l.b * y + l.c < -1e-9; })) continue;
        const auto u = static_cast<float>(x), v = static_cast<float>(y);
        row[x] = {m.a * u + m.b * v + m.c, m.d * u + m.e * v + m.f};
      }
    }
  }
}

cv::Mat identity_map(cv::Size size) {
  cv::Mat map(size, CV_32FC2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) map.at<cv::Vec2f>(y, x) = {static_cast<float>(x), static_cast<float>(y)};
  return map;
}

cv::Mat empty_map(cv::Size size) { return cv::Mat(size, CV_32FC2, cv::Scalar(-100, -100)); }

double smooth_step(double low, double high, double x) {
  const double s = std::clamp((x - low) / std::max(high - low, 1e-12), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace talkgraph
