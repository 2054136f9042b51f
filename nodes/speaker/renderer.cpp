#include "nodes/speaker/renderer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "graph/random.h"
#include "nodes/speaker/mesh.h"
#include "nodes/speaker/paint.h"

namespace talkgraph::face {
namespace {

constexpr int noise_margin = 64;  ///< the tile of noise is larger than a picture by this

/// A rectangle of the canvas drawn at part_scale before it goes into a picture.
struct Patch {
  Point origin;  ///< top left corner, units
  cv::Mat3b pixels;

  Patch(Point corner, double width, double height, cv::Scalar colour)
      : origin(corner), pixels(static_cast<int>(height * part_scale), static_cast<int>(width * part_scale)) {
    pixels.setTo(colour);
  }
  Point unit(int column, int row) const { return origin + Point(column + 0.5, row + 0.5) / part_scale; }
};

/// Lays a part with transparency on a patch, its middle at a point of the canvas.
void lay(Patch& patch, const cv::Mat4b& part, const Point& middle, double opacity = 1) {
  const Point corner = (middle - patch.origin) * part_scale - Point(part.cols, part.rows) / 2;
  const double x0 = std::floor(corner.x()), y0 = std::floor(corner.y());
  cv::Mat4b moved;
  const cv::Matx23d shift(1, 0, corner.x() - x0, 0, 1, corner.y() - y0);
  cv::warpAffine(part, moved, shift, {part.cols + 1, part.rows + 1});
  const cv::Rect there(static_cast<int>(x0), static_cast<int>(y0), moved.cols, moved.rows);
  const cv::Rect seen = there & cv::Rect({}, patch.pixels.size());
  const int strength = static_cast<int>(std::lround(256 * opacity));
  for (int y = seen.y; y < seen.y + seen.height; ++y) {
    auto* out = patch.pixels[y];
    const auto* in = moved[y - there.y];
    for (int x = seen.x; x < seen.x + seen.width; ++x) {
      const auto& p = in[x - there.x];
      const int cover = p[3] * strength;
      for (int k = 0; k < 3; ++k) out[x][k] = static_cast<uchar>(out[x][k] + (p[k] - out[x][k]) * cover / 65280);
    }
  }
}

/// The edges of a gap: upper and lower points from left to right, units.
struct Gap {
  std::vector<Point> upper, lower;

  double opening() const {
    double most = 0;
    for (std::size_t i = 0; i < upper.size(); ++i) most = std::max(most, lower[i].y() - upper[i].y());
    return most;
  }
};

/// Height of an edge at x.
double edge_at(const std::vector<Point>& edge, double x) {
  if (x <= edge.front().x()) return edge.front().y();
  for (std::size_t i = 1; i < edge.size(); ++i)
    if (x <= edge[i].x()) {
      const double t = (x - edge[i - 1].x()) / (edge[i].x() - edge[i - 1].x());
      return edge[i - 1].y() + t * (edge[i].y() - edge[i - 1].y());
    }
  return edge.back().y();
}

/// Bound points on both sides of a cut.
struct Cut {
  std::vector<Bound> upper, lower;

  Gap gap(const Movement& m) const {
    Gap g;
    for (const auto& p : upper) g.upper.push_back(place(p, m));
    for (const auto& p : lower) g.lower.push_back(place(p, m));
    return g;
  }
};

template <class Line>
Cut make_cut(double middle, double half, Line line, Part above, Part below) {
  Cut cut;
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    const double x = middle + half * (2.0 * i / steps - 1);
    cut.upper.push_back(bind({x, line(x)}, above));
    cut.lower.push_back(bind({x, line(x)}, below));
  }
  return cut;
}

double ramp(double from, double to, double x) {
  x = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// Darkens a patch: f(x, y) is the light there, 0 to 1, given the upper edge.
template <class F>
void dim(Patch& patch, const std::vector<Point>& edge, F light) {
  for (int c = 0; c < patch.pixels.cols; ++c) {
    const double x = patch.unit(c, 0).x(), top = edge_at(edge, x);
    for (int r = 0; r < patch.pixels.rows; ++r) patch.pixels(r, c) *= light(x, patch.unit(c, r).y() - top);
  }
}

/// The movement without that of the whole head.
Movement still(Movement m) {
  m.dx = m.dy = m.sine = 0;
  m.cosine = 1;
  return m;
}

cv::Mat3s make_noise(cv::Size size, std::uint64_t seed) {
  Random random(seed, "speaker.builtin", "noise");
  cv::Mat3s tile(size.height + noise_margin, size.width + noise_margin);
  for (auto& p : tile) {
    const double grey = 1.1 * random.normal();
    for (int k = 0; k < 3; ++k) p[k] = static_cast<short>(std::lround(grey + 0.7 * random.normal()));
  }
  return tile;
}

}  // namespace

cv::Size picture_size(int height) { return {height * 5 / 8 * 2, height}; }

Shape picture_landmarks(const std::vector<Bound>& points, const Moment& moment, int height) {
  const auto m = movement(moment);
  const double scale = height / canvas_height;
  Shape shape(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = place(points[i], m) * scale - Point(0.5, 0.5);
    shape.row(static_cast<Eigen::Index>(i)) << std::round(p.x() * 64) / 64, std::round(p.y() * 64) / 64;
  }
  return shape;
}

struct Renderer::Parts {
  cv::Size size;
  double scale;
  cv::Mat portrait;
  cv::Mat4b upper_teeth, lower_teeth, tongue, eyeball, iris;
  cv::Mat3s noise;
  Grid brow, cheek, chin;
  Cut lips, left_lids, right_lids;

  cv::Mat warp(const Movement& m) const;
  Patch inner_mouth(const Articulators& a, const Movement& m) const;
  Patch eye(double middle, const Cut& lids, const Moment& moment, const Movement& m) const;
  void insert(cv::Mat3b& picture, const Patch& patch, const Gap& gap, const Movement& m, double lash) const;
};

cv::Mat Renderer::Parts::warp(const Movement& m) const {
  const auto above = brow.placed(m), between = cheek.placed(m), below = chin.placed(m);
  CanvasMap canvas(size, scale);
  canvas.close_gap(brow, above, cheek, between);
  canvas.close_gap(cheek, between, chin, below);
  canvas.add(brow, above);
  canvas.add(cheek, between);
  canvas.add(chin, below);
  const cv::Mat pixels = canvas.map() * static_cast<double>(paint_scale) - cv::Scalar(0.5, 0.5);
  cv::Mat picture;
  cv::remap(portrait, picture, pixels, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return picture;
}

Patch Renderer::Parts::inner_mouth(const Articulators& a, const Movement& m) const {
  Patch patch({centre_x - 30, 194}, 60, 52, {16, 12, 38});
  const double biting = mouth_y + 3.4, lower_edge = mouth_y + 2.8 + 0.95 * m.jaw_drop;
  const double rise = a.tongue_tip * (5.5 + 0.38 * m.jaw_drop);
  lay(patch, tongue, {centre_x, lower_edge + 7.5 - rise});
  lay(patch, lower_teeth, {centre_x, lower_edge + 4});
  lay(patch, upper_teeth, {centre_x, biting - 4.6});
  if (a.tongue_out > 0.05)
    lay(patch, tongue, {centre_x, biting + 8.2 + 4 * (1 - a.tongue_out)}, std::min(1.0, 2 * a.tongue_out));
  const Gap gap = lips.gap(still(m));
  const double left = gap.upper.front().x(), right = gap.upper.back().x();
  dim(patch, gap.upper, [&](double x, double depth) {
    const double u = std::abs(2 * (x - left) / (right - left) - 1);
    return (0.56 + 0.44 * ramp(-0.5, 4.0, depth)) * (1 - 0.72 * ramp(0.45, 1.0, u)) * (1 - 0.25 * ramp(8, 24, depth));
  });
  return patch;
}

Patch Renderer::Parts::eye(double middle, const Cut& lids, const Moment& moment, const Movement& m) const {
  Patch patch({middle - 18, 123}, 36, 24, {});
  lay(patch, eyeball, {middle, 135});
  lay(patch, iris, {middle + moment.head.gaze_x, 134.3 + moment.head.gaze_y});
  dim(patch, lids.gap(still(m)).upper, [&](double x, double depth) {
    const double v = std::abs(x - middle) / eye_half_width;
    return (0.52 + 0.48 * ramp(-0.5, 4.2, depth)) * (1 - 0.25 * ramp(0.6, 1.05, v));
  });
  return patch;
}

/// Puts a patch into a gap, its edge smooth; with lashes `lash` units thick on the upper edge.
void Renderer::Parts::insert(cv::Mat3b& picture, const Patch& patch, const Gap& gap, const Movement& m,
                             double lash) const {
  constexpr int fine = 4, shift = 4;
  std::vector<cv::Point> outline, upper;
  std::vector<Point> points = gap.upper;
  points.insert(points.end(), gap.lower.rbegin(), gap.lower.rend());
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (const auto& p : points) {
    left = std::min(left, p.x() * scale), right = std::max(right, p.x() * scale);
    top = std::min(top, p.y() * scale), bottom = std::max(bottom, p.y() * scale);
  }
  const cv::Rect box = cv::Rect(static_cast<int>(left) - 3, static_cast<int>(top) - 4,
                                static_cast<int>(right - left) + 8, static_cast<int>(bottom - top) + 10) &
                       cv::Rect({}, size);
  if (box.empty()) return;
  const auto fixed = [&](const Point& p) {
    const double unit = fine * (1 << shift);
    return cv::Point(static_cast<int>(std::lround((p.x() * scale - box.x) * unit - unit / fine / 2)),
                     static_cast<int>(std::lround((p.y() * scale - box.y) * unit - unit / fine / 2)));
  };
  for (const auto& p : points) outline.push_back(fixed(p));
  cv::Mat1b large(box.height * fine, box.width * fine, uchar{0}), cover;
  cv::fillPoly(large, std::vector<std::vector<cv::Point>>{outline}, 255, cv::LINE_8, shift);
  cv::resize(large, cover, box.size(), 0, 0, cv::INTER_AREA);

  // From pixels of the patch to those of the box: the head's own turn.
  const auto moved = [&](const Point& p) {
    Bound b{};
    b.rest = p, b.head = 1;
    b.shifts.fill(Point::Zero());
    return Point(place(b, m) * scale - Point(box.x + 0.5, box.y + 0.5));
  };
  const Point o = moved(patch.unit(0, 0)), ex = moved(patch.unit(1, 0)) - o, ey = moved(patch.unit(0, 1)) - o;
  const cv::Matx23d turn(ex.x(), ey.x(), o.x(), ex.y(), ey.y(), o.y());
  cv::Mat soft, inside;
  cv::GaussianBlur(patch.pixels, soft, {}, 0.45 * part_scale / scale);
  cv::warpAffine(soft, inside, turn, box.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);

  cv::Mat1b line(cover.size(), uchar{0});
  if (lash > 0) {
    for (const auto& p : gap.upper) upper.push_back(fixed(p));
    large.setTo(0);
    cv::polylines(large, upper, false, 255, std::max(1, static_cast<int>(std::lround(lash * scale * fine))), cv::LINE_8,
                  shift);
    cv::resize(large, line, box.size(), 0, 0, cv::INTER_AREA);
  }
  const cv::Vec3b lash_colour(22, 26, 36);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      auto& out = picture(box.y + y, box.x + x);
      const auto& in = inside.at<cv::Vec3b>(y, x);
      for (int k = 0; k < 3; ++k) {
        int value = out[k] + (in[k] - out[k]) * cover(y, x) / 255;
        value += (lash_colour[k] - value) * line(y, x) * 4 / (255 * 5);
        out[k] = static_cast<uchar>(value);
      }
    }
}

Renderer::Renderer(int height, std::uint64_t seed) {
  const auto size = picture_size(height);
  parts_ = std::make_unique<const Parts>(Parts{
      size, height / canvas_height, paint_portrait(seed), paint_upper_teeth(), paint_lower_teeth(), paint_tongue(seed),
      paint_eyeball(seed), paint_iris(seed), make_noise(size, seed), make_grid(Part::brow), make_grid(Part::cheek),
      make_grid(Part::chin), make_cut(centre_x, mouth_half_width, lip_line, Part::cheek, Part::chin),
      make_cut(centre_x - eye_distance, eye_half_width, lid_line, Part::brow, Part::cheek),
      make_cut(centre_x + eye_distance, eye_half_width, lid_line, Part::brow, Part::cheek)});
}

Renderer::~Renderer() = default;

cv::Mat Renderer::draw(const Moment& moment, std::uint64_t grain) const {
  const auto& p = *parts_;
  const auto m = movement(moment);
  cv::Mat3b picture = p.warp(m);
  const auto speech = p.lips.gap(m);
  if (speech.opening() > 0.05) p.insert(picture, p.inner_mouth(moment.mouth, m), speech, m, 0);
  for (const auto& [middle, lids] :
       {std::pair(centre_x - eye_distance, &p.left_lids), std::pair(centre_x + eye_distance, &p.right_lids)})
    p.insert(picture, p.eye(middle, *lids, moment, m), lids->gap(m), m, 1.3);
  const int dx = static_cast<int>(grain % noise_margin), dy = static_cast<int>(grain / noise_margin % noise_margin);
  cv::Mat noisy;
  cv::add(picture, p.noise(cv::Rect({dx, dy}, p.size)), noisy, {}, CV_8U);
  return noisy;
}

}  // namespace talkgraph::face
