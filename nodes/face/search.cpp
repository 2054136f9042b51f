#include "nodes/face/search.h"

#include <algorithm>
#include <cmath>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

/// Some hundred pixels of the coarsest mean texture: enough to tell a face.
struct Template {
  std::vector<Eigen::Vector2f> places;  ///< model frame
  Eigen::VectorXf values;               ///< mean 0, norm 1
};

Template coarse_template(const AppearanceModel& model) {
  const auto& level = model.levels.back();
  const auto pixels = static_cast<std::size_t>(level.raster.size());
  const std::size_t stride = std::max<std::size_t>(1, pixels / 300);
  const auto onto_mean = affine_maps(level.raster.points, model.mean_shape, model.triangles);
  Template t;
  std::vector<float> values;
  for (std::size_t i = 0; i < pixels; i += stride) {
    const Affine& m = onto_mean[static_cast<std::size_t>(level.raster.triangle[i])];
    const auto x = static_cast<float>(level.raster.x[i]), y = static_cast<float>(level.raster.y[i]);
    t.places.emplace_back(m.a * x + m.b * y + m.c, m.d * x + m.e * y + m.f);
    for (std::size_t k = 0; k < 3; ++k) values.push_back((*level.mean)(static_cast<Eigen::Index>(3 * i + k), 0));
  }
  t.values = Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()));
  normalise(t.values);
  return t;
}

double window_error(const Template& t, const cv::Mat& picture, double scale, double dx, double dy,
                    Eigen::VectorXf& seen) {
  seen.resize(t.values.size());
  float* out = seen.data();
  const auto s = static_cast<float>(scale), x0 = static_cast<float>(dx), y0 = static_cast<float>(dy);
  for (const auto& place : t.places) {
    const int x = std::clamp(static_cast<int>(std::lround(s * place.x() + x0)), 0, picture.cols - 1);
    const int y = std::clamp(static_cast<int>(std::lround(s * place.y() + y0)), 0, picture.rows - 1);
    const float* pixel = picture.ptr<float>(y) + 3 * x;
    out[0] = pixel[0], out[1] = pixel[1], out[2] = pixel[2];
    out += 3;
  }
  normalise(seen);
  const double likeness = seen.dot(t.values);
  return 1 - std::max(0.0, likeness) * likeness;
}

}  // namespace

std::vector<Fit> search_windows(const AppearanceModel& model, Pyramid& pyramid, double range, int count) {
  const auto t = coarse_template(model);
  const cv::Size size = pyramid.level(0).size();
  const Eigen::RowVector2d low = model.mean_shape.colwise().minCoeff(), high = model.mean_shape.colwise().maxCoeff();
  const double extent = (high - low).maxCoeff();
  std::vector<Fit> found;
  Eigen::VectorXf seen;
  const int sizes = static_cast<int>(std::ceil(std::log(range) / std::log(1.12)));
  for (int i = -sizes; i <= sizes; ++i) {
    const double scale = model.picture_scale * std::pow(1.12, i), grid = 0.07 * extent * scale;
    const int k = pyramid.level_for(0.05 * extent * scale);
    const double reduced = std::exp2(-k);
    const cv::Mat& picture = pyramid.level(k);
    for (double y = -low.y() * scale * 0.8; y < size.height - high.y() * scale * 0.8; y += grid)
      for (double x = -low.x() * scale * 0.8; x < size.width - high.x() * scale * 0.8; x += grid) {
        Fit window;
        window.c = Eigen::VectorXd::Zero(model.modes());
        window.pose = {scale, 0, x, y};
        window.error = window_error(t, picture, scale * reduced, x * reduced, y * reduced, seen);
        found.push_back(std::move(window));
      }
  }
  std::stable_sort(found.begin(), found.end(), [](const Fit& a, const Fit& b) { return a.error < b.error; });
  std::vector<Fit> best;
  for (const auto& f : found) {
    if (static_cast<int>(best.size()) == count) break;
    const auto close = [&](const Fit& b) {
      return std::hypot(b.pose.dx - f.pose.dx, b.pose.dy - f.pose.dy) < 0.1 * extent * f.pose.scale &&
             std::abs(std::log(b.pose.scale / f.pose.scale)) < 0.15;
    };
    if (std::none_of(best.begin(), best.end(), close)) best.push_back(f);
  }
  return best;
}

}  // namespace talkgraph
