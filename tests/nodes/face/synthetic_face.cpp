#include "synthetic_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talkgraph::test {
namespace {

constexpr double pi = std::numbers::pi;

double chin(const SyntheticFace& f) { return 1.25 + 0.2 * f.open; }
double mouth_y(const SyntheticFace& f) { return 0.6 + 0.1 * f.open; }
double mouth_width(const SyntheticFace& f) { return 0.3 + 0.1 * f.wide; }
double mouth_height(const SyntheticFace& f) { return 0.06 + 0.16 * f.open; }

double soft(double edge) { return 1 / (1 + std::exp(-edge)); }

cv::Vec3d mix(const cv::Vec3d& a, const cv::Vec3d& b, double share) { return a + share * (b - a); }

cv::Vec3d colour(const SyntheticFace& f, double u, double v) {
  const double unstretched = v > 0 ? v * 1.25 / chin(f) : v;
  const double grain = 8 * std::sin(9 * u + 1) * std::cos(8 * unstretched);
  const cv::Vec3d skin(110 + 30 * u + grain, 140 + 20 * unstretched + grain, 200 - 25 * u * u + grain);
  cv::Vec3d at = mix({150, 110, 40}, skin, soft(40 * (1 - std::hypot(u, v / (v > 0 ? chin(f) : 1.25)))));
  for (const double side : {-0.4, 0.4})
    at = mix(at, {40, 35, 30}, soft(6 * (1 - std::hypot((u - side) / 0.14, (v + 0.35) / 0.08))));
  at = mix(at, {90, 110, 160}, soft(6 * (1 - std::hypot(u / 0.12, (v - 0.05) / 0.2))));
  const double mouth = std::hypot(u / mouth_width(f), (v - mouth_y(f)) / mouth_height(f));
  return mix(at, {60, 40, 120}, soft(6 * (1 - mouth)));
}

}  // namespace

cv::Mat draw(const SyntheticFace& f) {
  cv::Mat picture(synthetic_size, synthetic_size, CV_8UC3);
  const double c = std::cos(f.angle) / f.radius, s = std::sin(f.angle) / f.radius;
  for (int y = 0; y < synthetic_size; ++y)
    for (int x = 0; x < synthetic_size; ++x) {
      const auto value = colour(f, c * (x - f.x) + s * (y - f.y), -s * (x - f.x) + c * (y - f.y));
      for (int k = 0; k < 3; ++k)
        picture.at<cv::Vec3b>(y, x)[k] = cv::saturate_cast<unsigned char>(f.gain * value[k] + f.offset);
    }
  return picture;
}

Shape landmarks(const SyntheticFace& f) {
  std::vector<Eigen::RowVector2d> points;
  for (int i = 0; i < 16; ++i) {
    const double a = 2 * pi * i / 16;
    points.push_back({std::cos(a), std::sin(a) * (std::sin(a) > 0 ? chin(f) : 1.25)});
  }
  for (const double side : {-0.4, 0.4})
    for (int i = 0; i < 4; ++i)
      points.push_back({side + 0.14 * std::cos(pi * i / 2), -0.35 + 0.08 * std::sin(pi * i / 2)});
  for (int i = 0; i < 4; ++i) points.push_back({0.12 * std::cos(pi * i / 2), 0.05 + 0.2 * std::sin(pi * i / 2)});
  for (int i = 0; i < 8; ++i)
    points.push_back({mouth_width(f) * std::cos(pi * i / 4), mouth_y(f) + mouth_height(f) * std::sin(pi * i / 4)});
  Shape shape(points.size(), 2);
  const double c = f.radius * std::cos(f.angle), s = f.radius * std::sin(f.angle);
  for (std::size_t i = 0; i < points.size(); ++i)
    shape.row(static_cast<Eigen::Index>(i)) << c * points[i].x() - s * points[i].y() + f.x,
        s * points[i].x() + c * points[i].y() + f.y;
  return shape;
}

Prototypes synthetic_prototypes(int per_side) {
  Prototypes p;
  p.scheme = "synthetic";
  for (int i = 0; i < per_side * per_side; ++i) {
    SyntheticFace f;
    f.open = static_cast<double>(i % per_side) / (per_side - 1);
    f.wide = static_cast<double>(i / per_side) / (per_side - 1);
    f.x += 0.3 * (i % 5);
    f.angle = 0.02 * (i % 3 - 1);
    p.images.push_back({draw(f)});
    p.shapes.push_back(landmarks(f));
  }
  return p;
}

SyntheticFace talking_face(int t) {
  SyntheticFace f;
  f.open = 0.5 - 0.45 * std::cos(0.9 * t);
  f.wide = 0.5 + 0.4 * std::sin(0.5 * t);
  f.x += 3 * std::sin(0.3 * t);
  f.y += 2 * std::sin(0.2 * t);
  f.angle = 0.05 * std::sin(0.25 * t);
  return f;
}

double rms_distance(const Shape& a, const Shape& b) { return std::sqrt((a - b).rowwise().squaredNorm().mean()); }

double psnr(const cv::Mat& a, const cv::Mat& b) {
  const double mse = cv::norm(a, b, cv::NORM_L2SQR) / static_cast<double>(a.total() * 3);
  return 10 * std::log10(255 * 255 / std::max(mse, 1e-9));
}

}  // namespace talkgraph::test
