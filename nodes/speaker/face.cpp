#include "nodes/speaker/face.h"

#include <algorithm>
#include <cmath>

namespace talkgraph::face {
namespace {

double ramp(double from, double to, double x) {
  x = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

double bump(double x, double width) { return std::exp(-0.5 * x * x / (width * width)); }

/// 1 in the middle of a gap, 0 at its corners (|u| = 1).
double gap_profile(double u, double power) { return std::abs(u) < 1 ? std::pow(1 - u * u, power) : 0; }

/// -1 to 1 across the nearer eye.
double across_eye(double x) { return (std::abs(x - centre_x) - eye_distance) / eye_half_width; }
double across_mouth(double x) { return (x - centre_x) / mouth_half_width; }

enum Kind {
  jaw,
  upper_up,
  lower_down,
  spread,
  corners_up,
  upper_thick,
  lower_thick,
  upper_lid,
  lower_lid,
  brow_up,
  yaw,
  pitch,
  cheeks
};

/// How much the jaw carries a point along.
double jaw_share(double x, double y) {
  return ramp(188, 236, y) * (1 - ramp(249, 273, y)) * (1 - ramp(38, 92, std::abs(x - centre_x)));
}

/// Nearness to the viewer, 1 at the nose: what turning the head moves.
double depth(double x, double y) {
  const double r = std::pow((x - centre_x) / 80, 2) + std::pow((y - 150) / 115, 2);
  return 0.7 * std::exp(-r) + 0.3 * bump(x - centre_x, 10) * bump(y - 166, 16);
}

/// The head as a whole moves; the picture behind and below it does not.
double head_share(double x, double y) {
  const double r = std::hypot((x - centre_x) / 88, (y - 138) / 125);
  return 1 - ramp(1.0, 1.6, r);
}

/// Corners move by 1; skin beyond follows less and less.
double spread_profile(double u) {
  const double beyond = std::abs(u) - 1;
  return beyond <= 0 ? u : std::copysign(std::exp(-beyond * beyond / 0.5) * (1 + beyond), u);
}

}  // namespace

double lid_line(double x) {
  const double v = across_eye(x);
  return 136.5 + 2.4 * std::exp(-1.4 * v * v);
}

double lip_line(double x) {
  const double u = across_mouth(x);
  const double corners = 1.5 * std::exp(-5 * (std::abs(u) - 1) * (std::abs(u) - 1));
  return mouth_y - corners + 1.2 * std::exp(-8 * u * u) -
         0.9 * std::exp(-6 * (std::abs(u) - 0.55) * (std::abs(u) - 0.55));
}

double half_width(double y) {
  const double t = std::clamp((y - jaw_top) / (chin_bottom - jaw_top), 0.0, 1.0);
  return 68 * std::pow(1 - std::pow(t, 2.35), 0.54);
}

Movement movement(const Moment& moment) {
  const auto& a = moment.mouth;
  const auto& h = moment.head;
  const double pout = std::max(0.0, a.protrusion), open = 1 - a.closure;
  Movement m{};
  m.jaw_drop = 18.5 * a.jaw;
  const double parted = 0.95 * m.jaw_drop + 2.2 * a.upper_lip + 2.6 * a.lower_lip + 1.2 * pout - 1.6;
  const double free = std::max(0.0, parted);
  const double bitten = std::min(free, 2.4);
  m.gap = open * (free + a.bite * (bitten - free));
  const double raised = std::min(m.gap, 0.20 * m.gap + 1.6 * a.upper_lip * open);
  auto& k = m.amounts;
  k[jaw] = m.jaw_drop;
  k[upper_up] = raised;
  k[lower_down] = m.gap - raised;
  k[spread] = 4.6 * a.width - 6.5 * pout;
  k[corners_up] = 1.6 * std::max(0.0, a.width) - 0.8 * pout;
  k[upper_thick] = 2.2 * pout - 0.8 * std::max(0.0, a.width) - 1.3 * a.closure;
  k[lower_thick] = 2.4 * pout - 0.8 * std::max(0.0, a.width) - 1.3 * a.closure - 2.2 * a.bite;
  k[upper_lid] = 9.2 * (1 - h.blink);
  k[lower_lid] = 1.6 * (1 - h.blink);
  k[brow_up] = 4 * h.brow;
  k[yaw] = h.yaw;
  k[pitch] = h.pitch;
  k[cheeks] = 1.5 * std::max(0.0, a.width) - 1.2 * a.jaw;
  m.dx = h.dx, m.dy = h.dy;
  m.cosine = h.scale * std::cos(h.roll), m.sine = h.scale * std::sin(h.roll);
  return m;
}

Bound bind(const Point& p, Part part) {
  Bound b;
  b.rest = p;
  b.shifts.fill(Point::Zero());
  const double x = p.x(), y = p.y(), u = across_mouth(x), v = across_eye(x);
  const double lips = gap_profile(u, 0.6), lids = gap_profile(v, 0.62);
  const double line = lip_line(x), lid = lid_line(x);
  const double side = x < centre_x ? -1 : 1;

  b.shifts[jaw].y() = jaw_share(x, y);
  b.shifts[spread].x() = spread_profile(u) * bump(y - mouth_y, 15);
  b.shifts[corners_up].y() = -bump(std::abs(u) - 1, 0.4) * bump(y - mouth_y, 9);
  if (part == Part::cheek) {
    b.shifts[upper_up].y() = -lips * ramp(178, line - 1, y);
    b.shifts[upper_thick].y() = -lips * bump(y - (line - 8), 4) * std::min(1.0, (line - y) / 6);
    b.shifts[lower_lid].y() = lids * (1 - ramp(0, 10, y - lid));
  }
  if (part == Part::chin) {
    b.shifts[lower_down].y() = lips * (1 - ramp(line + 4, 243, y));
    b.shifts[lower_thick].y() = lips * bump(y - (line + 10), 5) * std::min(1.0, (y - line) / 7);
  }
  if (part == Part::brow) {
    b.shifts[upper_lid].y() = -lids * (1 - ramp(0, 17, lid - y));
    b.shifts[brow_up].y() = -bump(std::abs(x - centre_x) - 30, 24) * bump(y - 107, 9);
  }
  b.shifts[yaw].x() = depth(x, y);
  b.shifts[pitch].y() = depth(x, y);
  b.shifts[cheeks] = Point(side, -0.6) * bump(std::abs(x - centre_x) - 40, 13) * bump(y - 182, 16);
  b.head = head_share(x, y);
  return b;
}

Point place(const Bound& b, const Movement& m) {
  Point p = b.rest;
  for (std::size_t i = 0; i < movements; ++i) p += m.amounts[i] * b.shifts[i];
  constexpr double pivot_x = centre_x, pivot_y = 215;
  const double x = p.x() - pivot_x, y = p.y() - pivot_y;
  const Point moved(pivot_x + m.cosine * x - m.sine * y + m.dx, pivot_y + m.sine * x + m.cosine * y + m.dy);
  return p + b.head * (moved - p);
}

std::vector<Bound> landmarks() {
  std::vector<Bound> all;
  const auto add = [&](double x, double y, Part part) { all.push_back(bind({x, y}, part)); };
  const auto part_of = [](double x, double y) {
    return y < lid_line(x) ? Part::brow : y < lip_line(x) ? Part::cheek : Part::chin;
  };
  const auto add_off_cuts = [&](double dx, double y) { add(centre_x + dx, y, part_of(centre_x + dx, y)); };
  // 0-16: the jaw, from the ear on the left of the picture to the other.
  constexpr double heights[] = {132, 150, 168, 186, 203, 219, 233, 243};
  for (const double y : heights) add_off_cuts(-half_width(y), y);
  add_off_cuts(0, chin_bottom);
  for (int i = 7; i >= 0; --i) add_off_cuts(half_width(heights[i]), heights[i]);
  // 17-26: the brows.
  const Point brow[] = {{-52, 112}, {-45, 106}, {-36, 103.5}, {-27, 105}, {-18, 108.5}};
  for (int i = 0; i < 5; ++i) add_off_cuts(brow[i].x(), brow[i].y());
  for (int i = 4; i >= 0; --i) add_off_cuts(-brow[i].x(), brow[i].y());
  // 27-35: the bridge of the nose and its base.
  for (const double y : {128.0, 141.0, 154.0, 167.0}) add_off_cuts(0, y);
  const Point base[] = {{-13, 176}, {-7, 178.5}, {0, 180}, {7, 178.5}, {13, 176}};
  for (const auto& p : base) add_off_cuts(p.x(), p.y());
  // 36-47: the lids: outer corner, upper lid, inner corner, lower lid; then the other eye from its inner corner.
  const auto add_eye = [&](double middle) {
    const auto on_line = [&](double v, Part part) {
      const double x = middle + v * eye_half_width;
      add(x, lid_line(x), part);
    };
    on_line(-1, Part::brow), on_line(-0.4, Part::brow), on_line(0.4, Part::brow);
    on_line(1, Part::brow), on_line(0.4, Part::cheek), on_line(-0.4, Part::cheek);
  };
  add_eye(centre_x - eye_distance), add_eye(centre_x + eye_distance);
  // 48-59: outer lips, from the left corner over the upper lip; 60-67: inner lips likewise.
  const auto lip = [&](double u, double dy, Part part) {
    const double x = centre_x + u * mouth_half_width;
    add(x, lip_line(x) + dy, part);
  };
  lip(-1, 0, Part::cheek), lip(-0.6, -5.2, Part::cheek), lip(-0.2, -8.2, Part::cheek), lip(0, -7.2, Part::cheek);
  lip(0.2, -8.2, Part::cheek), lip(0.6, -5.2, Part::cheek), lip(1, 0, Part::cheek);
  lip(0.6, 6.8, Part::chin), lip(0.25, 9.8, Part::chin), lip(0, 10.2, Part::chin), lip(-0.25, 9.8, Part::chin),
      lip(-0.6, 6.8, Part::chin);
  lip(-0.9, 0, Part::cheek), lip(-0.4, 0, Part::cheek), lip(0, 0, Part::cheek), lip(0.4, 0, Part::cheek);
  lip(0.9, 0, Part::cheek), lip(0.4, 0, Part::chin), lip(0, 0, Part::chin), lip(-0.4, 0, Part::chin);
  return all;
}

}  // namespace talkgraph::face
