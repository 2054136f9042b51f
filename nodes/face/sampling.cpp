#include "nodes/face/sampling.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

double spread(const Shape& shape) { return (shape.rowwise() - shape.colwise().mean()).norm(); }

/// A float picture of three channels.
struct Pixels {
  explicit Pixels(const cv::Mat& picture)
      : data(picture.ptr<float>()),
        step(static_cast<std::ptrdiff_t>(picture.step1())),
        right(static_cast<float>(picture.cols - 1)),
        bottom(static_cast<float>(picture.rows - 1)),
        last_x(std::max(picture.cols - 2, 0)),
        last_y(std::max(picture.rows - 2, 0)),
        beside(picture.cols > 1 ? 3 : 0),
        below(picture.rows > 1 ? step : 0) {}

  /// Whether the pixels to the right of a position and below it are there as well.
  bool hold(const Eigen::Array2f& p) const { return p.x() >= 0 && p.y() >= 0 && p.x() < right && p.y() < bottom; }

  /// Bilinear value at such a position: three channels, and a fourth number that means nothing.
  Eigen::Array4f at(const Eigen::Array2f& p) const {
    return between(static_cast<int>(p.x()), static_cast<int>(p.y()), p);
  }

  Eigen::Array4f at_border(const Eigen::Array2f& p) const {
    const Eigen::Array2f q(std::min(std::max(p.x(), 0.f), right), std::min(std::max(p.y(), 0.f), bottom));
    return between(std::min(static_cast<int>(q.x()), last_x), std::min(static_cast<int>(q.y()), last_y), q);
  }

  Eigen::Array4f between(int x0, int y0, const Eigen::Array2f& p) const {
    using Pixel = Eigen::Map<const Eigen::Array4f>;
    const float u = p.x() - static_cast<float>(x0), v = p.y() - static_cast<float>(y0);
    const float* top = data + y0 * step + 3 * x0;
    const float* low = top + below;
    const Eigen::Array4f upper = Pixel(top) + u * (Pixel(top + beside) - Pixel(top));
    const Eigen::Array4f lower = Pixel(low) + u * (Pixel(low + beside) - Pixel(low));
    return upper + v * (lower - upper);
  }

  const float* data;
  std::ptrdiff_t step;
  float right, bottom;
  int last_x, last_y;
  std::ptrdiff_t beside, below;
};

/// Room for a picture in whose last pixel four floats can be read.
cv::Mat roomy(cv::Size size) { return cv::Mat(size.height + 1, size.width, CV_32FC3).rowRange(0, size.height); }

}  // namespace

Pyramid::Pyramid(const cv::Mat& picture) : levels_{roomy(picture.size())} { picture.convertTo(levels_[0], CV_32FC3); }

const cv::Mat& Pyramid::level(int k) {
  while (static_cast<int>(levels_.size()) <= k) {
    const cv::Mat& last = levels_.back();
    cv::Mat half = roomy({(last.cols + 1) / 2, (last.rows + 1) / 2});
    cv::pyrDown(last, half);
    levels_.push_back(half);
  }
  return levels_[static_cast<std::size_t>(k)];
}

int Pyramid::level_for(double pixels) {
  const int deepest = static_cast<int>(std::log2(std::max(1, std::min(levels_[0].cols, levels_[0].rows) / 4)));
  return std::clamp(static_cast<int>(std::lround(std::log2(std::max(pixels, 1e-6)))), 0, deepest);
}

std::vector<Run> runs(const Raster& raster) {
  std::vector<Run> out;
  for (std::size_t i = 0; i < raster.x.size(); ++i) {
    const int x = raster.x[i], y = raster.y[i], triangle = raster.triangle[i];
    if (!out.empty() && out.back().y == y && out.back().triangle == triangle && out.back().x + out.back().length == x)
      ++out.back().length;
    else
      out.push_back({x, y, triangle, 1});
  }
  return out;
}

Sampler::Sampler(const Raster& raster, const Triangles& triangles)
    : points_(raster.points),
      spread_(spread(raster.points)),
      triangles_(triangles),
      runs_(runs(raster)),
      size_(raster.size()) {}

void Sampler::operator()(Pyramid& pyramid, const Shape& shape, Eigen::VectorXf& texture) const {
  const int k = pyramid.level_for(spread(shape) / spread_);
  const Pixels pixels(pyramid.level(k));
  const auto maps = affine_maps(points_, shape / std::exp2(k), triangles_);
  texture.resize(3 * size_);
  PixelWriter out(texture.data(), size_);
  for (const Run& run : runs_) {
    const Affine& m = maps[static_cast<std::size_t>(run.triangle)];
    const auto y = static_cast<float>(run.y);
    const auto at = [&, x0 = m.b * y + m.c, y0 = m.e * y + m.f](int i) {
      const auto x = static_cast<float>(run.x + i);
      return Eigen::Array2f(m.a * x + x0, m.d * x + y0);
    };
    const bool inside = pixels.hold(at(0)) && pixels.hold(at(run.length - 1));
    for (int i = 0; i < run.length; ++i) out.write(inside ? pixels.at(at(i)) : pixels.at_border(at(i)));
  }
}

void sample(Pyramid& pyramid, const Shape& shape, const Triangles& triangles, const Raster& raster,
            Eigen::VectorXf& texture) {
  Sampler(raster, triangles)(pyramid, shape, texture);
}

cv::Mat raster_picture(const Raster& raster, const Eigen::VectorXf& texture, cv::Scalar fill) {
  cv::Mat picture(raster.height, raster.width, CV_32FC3, fill);
  for (std::size_t i = 0; i < raster.x.size(); ++i) {
    const float* value = texture.data() + 3 * i;
    picture.at<cv::Vec3f>(raster.y[i], raster.x[i]) = {value[0], value[1], value[2]};
  }
  return picture;
}

Photometry normalise(Eigen::VectorXf& texture) {
  Photometry p;
  p.offset = texture.cast<double>().mean();
  texture.array() -= static_cast<float>(p.offset);
  p.gain = texture.cast<double>().norm();
  if (p.gain < 1e-3) p.gain = 0;
  texture *= static_cast<float>(p.gain > 0 ? 1 / p.gain : 0);
  return p;
}

}  // namespace talkgraph
