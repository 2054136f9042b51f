#include "nodes/face/sampling.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

/// Bilinear value of the three channels, borders repeated.
inline void bilinear(const float* pixels, std::ptrdiff_t step, int width, int height, float x, float y, float* out) {
  x = std::min(std::max(x, 0.f), static_cast<float>(width - 1));
  y = std::min(std::max(y, 0.f), static_cast<float>(height - 1));
  const int x0 = std::min(static_cast<int>(x), std::max(width - 2, 0)),
            y0 = std::min(static_cast<int>(y), std::max(height - 2, 0));
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  const float* top = pixels + y0 * step + 3 * x0;
  const float* bottom = height > 1 ? top + step : top;
  const int right = width > 1 ? 3 : 0;
  for (int c = 0; c < 3; ++c) {
    const float upper = top[c] + u * (top[c + right] - top[c]);
    const float lower = bottom[c] + u * (bottom[c + right] - bottom[c]);
    out[c] = upper + v * (lower - upper);
  }
}

}  // namespace

Pyramid::Pyramid(const cv::Mat& picture) : levels_(1) { picture.convertTo(levels_[0], CV_32FC3); }

const cv::Mat& Pyramid::level(int k) {
  while (static_cast<int>(levels_.size()) <= k) {
    cv::Mat half;
    cv::pyrDown(levels_.back(), half);
    levels_.push_back(half);
  }
  return levels_[static_cast<std::size_t>(k)];
}

int Pyramid::level_for(double pixels) {
  const int deepest = static_cast<int>(std::log2(std::max(1, std::min(levels_[0].cols, levels_[0].rows) / 4)));
  return std::clamp(static_cast<int>(std::lround(std::log2(std::max(pixels, 1e-6)))), 0, deepest);
}

void sample(Pyramid& pyramid, const Shape& shape, const Triangles& triangles, const Raster& raster,
            Eigen::VectorXf& texture) {
  const double spread = (shape.rowwise() - shape.colwise().mean()).norm();
  const double raster_spread = (raster.points.rowwise() - raster.points.colwise().mean()).norm();
  const int k = pyramid.level_for(spread / raster_spread);
  const cv::Mat& picture = pyramid.level(k);
  const auto maps = affine_maps(raster.points, shape / std::exp2(k), triangles);
  texture.resize(3 * raster.size());
  const auto* pixels = picture.ptr<float>();
  const auto step = static_cast<std::ptrdiff_t>(picture.step1());
  float* out = texture.data();
  for (std::size_t i = 0; i < raster.x.size(); ++i, out += 3) {
    const Affine& m = maps[static_cast<std::size_t>(raster.triangle[i])];
    const auto x = static_cast<float>(raster.x[i]), y = static_cast<float>(raster.y[i]);
    bilinear(pixels, step, picture.cols, picture.rows, m.a * x + m.b * y + m.c, m.d * x + m.e * y + m.f, out);
  }
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
