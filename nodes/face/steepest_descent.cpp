#include "nodes/face/steepest_descent.h"

#include <algorithm>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

using Channels = Eigen::Array<float, 3, Eigen::Dynamic>;
using Gradient = Eigen::Array<float, 4, Eigen::Dynamic>;  // the fourth number means nothing

/// Half the difference of two neighbours, the whole where one is the pixel itself.
void differences(const Eigen::Map<const Channels>& texture, const std::vector<int>& before,
                 const std::vector<int>& after, Gradient& gradient) {
  gradient.setZero(4, texture.cols());
  for (int i = 0; i < static_cast<int>(texture.cols()); ++i) {
    const int a = before[static_cast<std::size_t>(i)], b = after[static_cast<std::size_t>(i)];
    gradient.col(i).head<3>() = (texture.col(b) - texture.col(a)) * (a == i || b == i ? 1.f : 0.5f);
  }
}

/// A move in the frame that `warp` leads to as one of raster pixels; none where a triangle has no area.
Affine on_raster(const Affine& warp, const Affine& m) {
  const float area = warp.a * warp.e - warp.b * warp.d;
  if (area == 0) return {};
  const float a = warp.e / area, b = -warp.b / area, d = -warp.d / area, e = warp.a / area;
  return {a * m.a + b * m.d, a * m.b + b * m.e, a * m.c + b * m.f,
          d * m.a + e * m.d, d * m.b + e * m.e, d * m.c + e * m.f};
}

}  // namespace

SteepestDescent::SteepestDescent(const Raster& raster, const Triangles& triangles)
    : points_(raster.points), triangles_(triangles), runs_(runs(raster)) {
  Eigen::MatrixXi index = Eigen::MatrixXi::Constant(raster.height, raster.width, -1);
  const auto pixels = static_cast<int>(raster.size());
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>(i);
    index(raster.y[at], raster.x[at]) = i;
  }
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto neighbour = [&](int x, int y) {
      const bool inside = x >= 0 && y >= 0 && x < raster.width && y < raster.height;
      return inside && index(y, x) >= 0 ? index(y, x) : i;
    };
    const int x = raster.x[at], y = raster.y[at];
    left_.push_back(neighbour(x - 1, y));
    right_.push_back(neighbour(x + 1, y));
    above_.push_back(neighbour(x, y - 1));
    below_.push_back(neighbour(x, y + 1));
  }
}

void SteepestDescent::operator()(const Shape& shape, const Eigen::MatrixXd& directions, const Eigen::VectorXf& texture,
                                 Eigen::Ref<Eigen::MatrixXf> images) const {
  const Eigen::Map<const Channels> channels(texture.data(), 3, texture.size() / 3);
  Gradient by_x, by_y;
  differences(channels, left_, right_, by_x);
  differences(channels, above_, below_, by_y);
  const auto warps = affine_maps(points_, shape, triangles_);
  for (Eigen::Index j = 0; j < directions.cols(); ++j) {
    auto moves = affine_maps(points_, unflatten(directions.col(j)), triangles_);
    for (std::size_t t = 0; t < moves.size(); ++t) moves[t] = on_raster(warps[t], moves[t]);
    PixelWriter image(images.col(j).data(), channels.cols());
    Eigen::Index i = 0;
    for (const Run& run : runs_) {
      const Affine& m = moves[static_cast<std::size_t>(run.triangle)];
      const auto y = static_cast<float>(run.y);
      const float x0 = m.b * y + m.c, y0 = m.e * y + m.f;
      for (int k = 0; k < run.length; ++k, ++i) {
        const auto x = static_cast<float>(run.x + k);
        image.write(by_x.col(i) * (m.a * x + x0) + by_y.col(i) * (m.d * x + y0));
      }
    }
  }
}

}  // namespace talkgraph
