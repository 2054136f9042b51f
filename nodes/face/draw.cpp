#include "nodes/face/draw.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

#include "nodes/face/geometry.h"
#include "nodes/face/sampling.h"

namespace talkgraph {
namespace {

constexpr double slack = 1e-9;  // a pixel on a side counts

/// A side of a triangle, from the top.
struct Side {
  Side(const Shape& p, int a, int b) {
    if (p(a, 1) > p(b, 1)) std::swap(a, b);
    x = p(a, 0), y = p(a, 1), height = p(b, 1) - y;
    slope = height > slack ? (p(b, 0) - x) / height : 0;
  }
  bool level() const { return height <= slack; }
  bool meets(int row) const { return row >= y - slack && row <= y + height + slack; }
  double at(int row) const { return x + std::clamp(row - y, 0.0, height) * slope; }

  double x, y, height, slope;
};

/// Calls run(y, first, last) for the pixels of each row of a picture that lie in a triangle.
template <class Run>
void for_rows(const Shape& p, const Eigen::RowVector3i& corners, cv::Size size, Run run) {
  const Side sides[3] = {{p, corners(0), corners(1)}, {p, corners(1), corners(2)}, {p, corners(2), corners(0)}};
  const auto [low, high] = std::minmax({p(corners(0), 1), p(corners(1), 1), p(corners(2), 1)});
  const auto not_before = [](double v, int n) {
    return static_cast<int>(std::ceil(std::clamp<double>(v, 0, n) - slack));
  };
  const auto not_after = [](double v, int n) {
    return static_cast<int>(std::floor(std::clamp<double>(v, -1, n - 1) + slack));
  };
  const int from = not_before(low, size.height), to = not_after(high, size.height);
  for (int row = from; row <= to; ++row) {
    double left = INFINITY, right = -INFINITY;
    for (const auto& side : sides)
      if (!side.level() && side.meets(row)) {
        left = std::min(left, side.at(row));
        right = std::max(right, side.at(row));
      }
    if (left > right) continue;
    const int first = not_before(left, size.width), last = not_after(right, size.width);
    if (first <= last) run(row, first, last);
  }
}

/// A picture of four channels, read between its pixels: positions in 1/65536 of one, values between them in 1/128.
class Texture {
 public:
  explicit Texture(const cv::Mat& picture)
      : pixels_(picture.data),
        step_(static_cast<std::ptrdiff_t>(picture.step)),
        last_((picture.cols - 1) * 65536 - 1, (picture.rows - 1) * 65536 - 1) {}

  static int position(float x) { return static_cast<int>(std::clamp(x, -16000.f, 16000.f) * 65536); }
  /// The nearest column or row that has another one behind it.
  int column(float x) const { return std::clamp(position(x), 0, last_.x); }
  int row(float y) const { return std::clamp(position(y), 0, last_.y); }
  /// Whether so many steps from a place in the picture lead nowhere outside.
  bool holds_steps(int x, int y, int right, int down, int steps) const {
    const std::int64_t end_x = x + std::int64_t{right} * steps, end_y = y + std::int64_t{down} * steps;
    return end_x >= 0 && end_x <= last_.x && end_y >= 0 && end_y <= last_.y;
  }

  /// The first three bytes count.
  unsigned at(int x, int y) const {
    const unsigned char* corner = pixels_ + (y >> 16) * step_ + 4 * (x >> 16);
    const auto upper = cv::v_load_expand(corner), lower = cv::v_load_expand(corner + step_);
    const auto down = cv::v_setall_u16(static_cast<unsigned short>(y >> 9 & 127));
    const auto column = cv::v_add_wrap(upper << 7, cv::v_mul_wrap(cv::v_sub_wrap(lower, upper), down));
    const auto sum = (cv::v_dotprod(beside(column), weights(x)) + cv::v_setall_s32(1 << 13)) >> 14;
    const auto narrow = cv::v_pack(sum, sum);
    return cv::v_reinterpret_as_u32(cv::v_pack_u(narrow, narrow)).get0();
  }

 private:
  /// Of a position's pixel and the next one, alternating.
  static cv::v_int16x8 weights(int position) {
    const int next = position >> 9 & 127;
    return cv::v_reinterpret_as_s16(cv::v_setall_s32((128 - next) | next << 16));
  }
  /// The four channels of one pixel and those of the next, alternating.
  static cv::v_int16x8 beside(const cv::v_uint16x8& two) {
    cv::v_uint16x8 pairs, unused;
    cv::v_zip(two, cv::v_combine_high(two, two), pairs, unused);
    return cv::v_reinterpret_as_s16(pairs);
  }

  const unsigned char* pixels_;
  std::ptrdiff_t step_;
  cv::Point last_;
};

/// Writes pixels first to last of a row, left to right: each but the last with a byte too many, which the next
/// overwrites.
template <class Value>
void write_row(cv::Vec3b* row, int first, int last, Value value) {
  for (int x = first; x < last; ++x) {
    const unsigned pixel = value(x);
    std::memcpy(row[x].val, &pixel, 4);
  }
  const unsigned pixel = value(last);
  std::memcpy(row[last].val, &pixel, 3);
}

/// The raster with its face; pixels around the face have the mean of their neighbours inside it.
cv::Mat padded(const Raster& raster, const Eigen::VectorXf& texture) {
  const cv::Mat picture = raster_picture(raster, texture),
                inside = raster_picture(raster, Eigen::VectorXf::Ones(texture.size()));
  cv::Mat sum, weight, around, mask;
  cv::boxFilter(picture, sum, CV_32F, {5, 5});
  cv::boxFilter(inside, weight, CV_32F, {5, 5});
  cv::divide(sum, cv::max(weight, 1e-6), around);
  cv::extractChannel(inside, mask, 0);
  picture.copyTo(around, mask > 0);
  return around;
}

}  // namespace

void draw_map(cv::Mat& map, const Shape& to, const Shape& from, const Triangles& triangles) {
  const auto maps = affine_maps(to, from, triangles);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Affine& m = maps[static_cast<std::size_t>(t)];
    for_rows(to, triangles.row(t), map.size(), [&](int y, int first, int last) {
      auto* row = map.ptr<cv::Vec2f>(y);
      const auto v = static_cast<float>(y);
      for (int x = first; x <= last; ++x) {
        const auto u = static_cast<float>(x);
        row[x] = {m.a * u + m.b * v + m.c, m.d * u + m.e * v + m.f};
      }
    });
  }
}

void draw_triangles(cv::Mat& picture, const Shape& to, const cv::Mat& texture, const Shape& from,
                    const Triangles& triangles) {
  const auto maps = affine_maps(to, from, triangles);
  const Texture source(texture);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Affine& m = maps[static_cast<std::size_t>(t)];
    const int right = Texture::position(m.a), down = Texture::position(m.d);
    for_rows(to, triangles.row(t), picture.size(), [&](int y, int first, int last) {
      auto* row = picture.ptr<cv::Vec3b>(y);
      const auto u = [&](int x) { return m.a * static_cast<float>(x) + m.b * static_cast<float>(y) + m.c; };
      const auto v = [&](int x) { return m.d * static_cast<float>(x) + m.e * static_cast<float>(y) + m.f; };
      const int left = source.column(u(first)), top = source.row(v(first));
      if (source.holds_steps(left, top, right, down, last - first))
        write_row(row, first, last,
                  [&](int x) { return source.at(left + (x - first) * right, top + (x - first) * down); });
      else
        write_row(row, first, last, [&](int x) { return source.at(source.column(u(x)), source.row(v(x))); });
    });
  }
}

cv::Mat draw_texture(const AppearanceModel& model, const Eigen::VectorXf& texture, const Shape& shape,
                     cv::Mat& picture) {
  const auto& raster = model.levels.at(0).raster;
  cv::Mat map = empty_map(picture.size()), face, mask;
  draw_map(map, shape, raster.points, model.triangles);
  cv::remap(padded(raster, texture), face, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  face.convertTo(face, CV_8UC3);
  cv::inRange(map, cv::Scalar(-50, -50), cv::Scalar(1e9, 1e9), mask);
  face.copyTo(picture, mask);
  return mask;
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
