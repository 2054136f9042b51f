#include "bench/drawn_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "graph/random.h"

namespace talkgraph::bench {
namespace {

using Point = Eigen::Vector2d;
constexpr double pi = std::numbers::pi;
constexpr std::size_t skin_patterns = 8;

// Head coordinates: the half width is 1, v grows towards the chin, which is at 1.25 with the mouth shut.
double chin(const DrawnFace& f) { return 1.22 + 0.2 * f.open; }
double outline(const DrawnFace& f, double v) { return v > 0 ? chin(f) : 1.3; }

struct Mouth {
  double y, width, upper, lower, gap, lift;

  double middle(double s) const { return y - lift * s * s; }
  static double arch(double s) { return std::max(0.0, 1 - s * s); }
};

Mouth mouth(const DrawnFace& f) {
  const double gap = 0.16 * std::max(0.0, f.open);
  return {0.62 + 0.1 * f.open, 0.34 + 0.07 * f.wide, 0.075 - 0.01 * f.wide, 0.095 + gap, gap, 0.06 * f.lift};
}

struct Brow {
  Point inner, outer;
};

Brow brow(const DrawnFace& f, double side) {
  const double height = -0.56 - 0.08 * f.brow;
  return {{side * (0.2 - 0.04 * f.frown), height + 0.08 * f.frown}, {side * 0.64, height + 0.03}};
}

constexpr double eye_x = 0.41, eye_y = -0.33, eye_width = 0.15;
double eye_height(const DrawnFace& f) { return 0.015 + 0.075 * f.lids; }

/// Height of the face above the plane of its outline.
double depth(double u, double v) {
  const double nose = 0.25 * std::exp(-std::pow(u / 0.16, 2) - std::pow((v - 0.15) / 0.3, 2));
  return 0.8 * std::max(0.0, 1 - u * u - v * v / 1.6) + nose;
}

Point turned(const DrawnFace& f, const Point& p) {
  const double z = depth(p.x(), p.y());
  return {p.x() * std::cos(f.yaw) + z * std::sin(f.yaw), p.y() * std::cos(f.pitch) + z * std::sin(f.pitch)};
}

/// What `turned` carries to q, by iteration.
Point turned_back(const DrawnFace& f, const Point& q) {
  Point p = q;
  for (int i = 0; i < 6; ++i) {
    const double z = depth(p.x(), p.y());
    p = {(q.x() - z * std::sin(f.yaw)) / std::cos(f.yaw), (q.y() - z * std::sin(f.pitch)) / std::cos(f.pitch)};
  }
  return p;
}

double soft(double edge) { return edge < -12 ? 0 : edge > 12 ? 1 : 1 / (1 + std::exp(-edge)); }
void blend(cv::Vec3d& at, const cv::Vec3d& colour, double share) { at += share * (colour - at); }

cv::Vec3d behind(const Random& seed, double x, double y) {
  Random random = seed;
  cv::Vec3d colour(120, 110, 100);
  for (int i = 0; i < 4; ++i) {
    const double wave = std::cos(random.uniform(-4, 4) * x + random.uniform(-4, 4) * y + random.uniform(0, 6));
    colour += 18 * wave * cv::Vec3d(random.uniform(), random.uniform(), random.uniform());
  }
  return colour;
}

/// Skin with what moves along with the jaw.
cv::Vec3d skin(const DrawnFace& f, double u, double v) {
  const double w = v > 0 ? v * 1.3 / chin(f) : v;
  double grain = 5 * std::sin(17 * u + 3 * w + 1) * std::cos(15 * w - 4 * u) + 4 * std::cos(31 * u) * std::sin(27 * w);
  for (std::size_t i = 0; i < f.skin.size(); ++i) {
    const double angle = static_cast<double>(i) * pi / skin_patterns, pitch = 2 + 0.7 * static_cast<double>(i);
    grain += f.skin[i] * std::cos(pitch * (std::cos(angle) * u + std::sin(angle) * w) + static_cast<double>(i));
  }
  const double shade = 26 * f.side * u + 18 * f.top * w + 14 * depth(u, v);
  const double cheeks = std::exp(-std::pow((std::abs(u) - 0.5) / 0.2, 2) - std::pow((w - 0.2) / 0.25, 2));
  return {105 + grain + shade - 8 * cheeks, 132 + grain + shade - 10 * cheeks, 178 + grain + shade + 8 * cheeks};
}

void add_eyes_and_brows(const DrawnFace& f, double u, double v, cv::Vec3d& at) {
  for (const double side : {-1.0, 1.0}) {
    const double x = (u - side * eye_x) / eye_width, y = (v - eye_y) / eye_height(f);
    const double open = soft(9 * (1 - std::hypot(x, y)) * std::min(1.0, eye_height(f) / 0.05));
    cv::Vec3d eye(205, 205, 210);
    blend(eye, {60, 70, 60}, soft(60 * (0.075 - std::hypot(u - side * eye_x, v - eye_y))));
    blend(eye, {20, 20, 20}, soft(90 * (0.03 - std::hypot(u - side * eye_x, v - eye_y))));
    blend(at, eye, open);
    const auto [inner, outer] = brow(f, side);
    const Point along = outer - inner, from = Point(u, v) - inner;
    const double t = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double arch = 0.05 * 4 * t * (1 - t);
    blend(at, {45, 55, 75}, soft(70 * (0.035 - (from - t * along + Point(0, arch)).norm())));
  }
}

void add_nose(double u, double v, cv::Vec3d& at) {
  blend(at, {80, 100, 145}, 0.6 * soft(40 * (0.05 - std::hypot(std::abs(u) - 0.17, v - 0.22))));
  blend(at, {40, 45, 70}, soft(60 * (0.035 - std::hypot(std::abs(u) - 0.09, 1.4 * (v - 0.29)))));
  blend(at, {130, 160, 210}, 0.5 * soft(30 * (0.04 - std::abs(u))) * soft(12 * (0.2 - v)) * soft(12 * (v + 0.3)));
}

void add_mouth(const DrawnFace& f, double u, double v, cv::Vec3d& at) {
  const auto m = mouth(f);
  const double s = u / m.width, arch = Mouth::arch(s), y = v - m.middle(s);
  blend(at, {85, 80, 165},
        soft(60 * (y + m.upper * arch)) * soft(60 * (m.lower * arch - y)) * soft(40 * (1.02 - std::abs(s))));
  cv::Vec3d inside(30, 25, 50);
  blend(inside, {190, 205, 210}, soft(80 * (0.05 - y)) * soft(30 * (0.6 - std::abs(s))));
  blend(at, inside, soft(70 * (y + 0.012)) * soft(70 * (m.gap * arch - y)) * soft(40 * (0.95 - std::abs(s))));
}

cv::Vec3d colour(const DrawnFace& f, const Random& background, const Point& q) {
  const Point p = turned_back(f, q);
  cv::Vec3d at = behind(background, q.x(), q.y());
  const double inside = soft(45 * (1 - std::hypot(p.x(), p.y() / outline(f, p.y()))));
  if (inside < 1e-3) return at;
  cv::Vec3d face = skin(f, p.x(), p.y());
  add_eyes_and_brows(f, p.x(), p.y(), face);
  add_nose(p.x(), p.y(), face);
  add_mouth(f, p.x(), p.y(), face);
  blend(at, face, inside);
  return at;
}

std::vector<Point> head_points(const DrawnFace& f) {
  std::vector<Point> points;
  for (int i = 0; i < 17; ++i) {
    const double a = pi * (1.08 - 1.16 * i / 16);
    points.push_back({std::cos(a), std::sin(a) * outline(f, std::sin(a))});
  }
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i < 5; ++i) {
      const double t = 0.25 * i;
      const auto [inner, outer] = brow(f, side);
      points.push_back(inner + t * (outer - inner) - Point(0, 0.05 * 4 * t * (1 - t)));
    }
  for (int i = 0; i < 4; ++i) points.push_back({0, -0.3 + 0.15 * i});
  for (int i = 0; i < 5; ++i) points.push_back({0.085 * (i - 2), 0.29 - 0.02 * std::abs(i - 2)});
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i < 6; ++i)
      points.push_back({side * eye_x + eye_width * std::cos(pi * i / 3), eye_y + eye_height(f) * std::sin(pi * i / 3)});
  const auto m = mouth(f);
  for (int i = 0; i < 12; ++i) {
    const double s = std::cos(pi * i / 6), height = i < 6 ? m.lower : -m.upper;
    points.push_back({m.width * s, m.middle(s) + height * Mouth::arch(s)});
  }
  return points;
}

}  // namespace

DrawnFace random_face(std::uint64_t seed) {
  Random random(seed, "face", "");
  DrawnFace f;
  f.seed = seed;
  f.x += 8 * random.normal();
  f.y += 8 * random.normal();
  f.radius *= std::exp(0.05 * random.normal());
  f.roll = 0.06 * random.normal();
  f.yaw = 0.12 * random.normal();
  f.pitch = 0.08 * random.normal();
  f.open = std::max(0.0, 0.4 + 0.3 * random.normal());
  f.wide = random.normal();
  f.lift = random.normal();
  f.brow = random.normal();
  f.frown = random.normal();
  f.lids = std::clamp(0.7 + 0.25 * random.normal(), 0.05, 1.2);
  f.gain = std::exp(0.1 * random.normal());
  f.offset = 6 * random.normal();
  f.side = random.normal();
  f.top = random.normal();
  for (std::size_t i = 0; i < skin_patterns; ++i) f.skin.push_back(4 * random.normal());
  return f;
}

DrawnFace speaking_face(int frame) {
  const double t = frame / 25.0;
  const auto wave = [t](double hertz, double phase) { return std::sin(2 * pi * hertz * t + phase); };
  DrawnFace f = random_face(9999);
  f.x = 150 + 7 * wave(0.4, 0);
  f.y = 135 + 5 * wave(0.3, 1);
  f.roll = 0.06 * wave(0.25, 2);
  f.yaw = 0.14 * wave(0.35, 0);
  f.pitch = 0.08 * wave(0.45, 1);
  f.open = std::max(0.0, 0.4 + 0.35 * wave(2.6, 0) + 0.15 * wave(4.1, 1));
  f.wide = 1.1 * wave(1.7, 2);
  f.lift = wave(0.6, 1);
  f.brow = wave(0.5, 2);
  f.frown = wave(0.3, 0);
  f.lids = frame % 60 > 56 ? 0.1 : 0.75;
  f.side = wave(0.1, 1);
  f.top = wave(0.15, 0);
  f.seed = static_cast<std::uint64_t>(10000 + frame);
  return f;
}

cv::Mat draw(const DrawnFace& f) {
  Random random(f.seed, "picture", "");
  const Random background = random;
  cv::Mat_<cv::Vec3f> picture(drawn_size, drawn_size);
  const double c = std::cos(f.roll) / f.radius, s = std::sin(f.roll) / f.radius;
  for (int y = 0; y < drawn_size; ++y)
    for (int x = 0; x < drawn_size; ++x)
      picture(y, x) = f.gain * colour(f, background, {c * (x - f.x) + s * (y - f.y), -s * (x - f.x) + c * (y - f.y)}) +
                      cv::Vec3d::all(f.offset);
  cv::GaussianBlur(picture, picture, {}, 0.7);
  for (auto& pixel : picture)
    for (int k = 0; k < 3; ++k) pixel[k] += static_cast<float>(drawn_noise * random.normal());
  cv::Mat out;
  picture.convertTo(out, CV_8UC3);
  return out;
}

Shape landmarks(const DrawnFace& f) {
  const auto points = head_points(f);
  Shape shape(points.size(), 2);
  const double c = f.radius * std::cos(f.roll), s = f.radius * std::sin(f.roll);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point q = turned(f, points[i]);
    shape.row(static_cast<Eigen::Index>(i)) << c * q.x() - s * q.y() + f.x, s * q.x() + c * q.y() + f.y;
  }
  return shape;
}

}  // namespace talkgraph::bench
