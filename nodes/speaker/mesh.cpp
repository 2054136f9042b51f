#include "nodes/speaker/mesh.h"

#include <algorithm>
#include <cmath>

namespace talkgraph::face {
namespace {

/// Close together where lips and lids bend; corners of both are columns.
std::vector<double> column_positions() {
  std::vector<double> all;
  constexpr double margin = 12, fine_from = centre_x - 54, fine_to = centre_x + 54;
  for (double x = -margin; x < fine_from - 1; x += 6) all.push_back(x);
  for (double x = fine_from; x <= fine_to; x += 2.25) all.push_back(x);
  for (double x = fine_to + 6; x <= canvas_width + margin; x += 6) all.push_back(x);
  for (const double side : {-1.0, 1.0})
    for (const double corner : {-1.0, 1.0}) all.push_back(centre_x + side * eye_distance + corner * eye_half_width);
  std::sort(all.begin(), all.end());
  return all;
}

double top_of(Part part, double x) {
  return part == Part::brow ? -12 : part == Part::cheek ? lid_line(x) : lip_line(x);
}
double bottom_of(Part part, double x) {
  return part == Part::brow ? lid_line(x) : part == Part::cheek ? lip_line(x) : canvas_height + 12;
}
int rows_of(Part part) { return part == Part::brow ? 26 : part == Part::cheek ? 20 : 22; }

/// Twice the signed area of a triangle.
double area(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

std::vector<Point> Grid::placed(const Movement& movement) const {
  std::vector<Point> all(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) all[i] = place(points[i], movement);
  return all;
}

Grid make_grid(Part part) {
  const auto columns = column_positions();
  Grid grid;
  grid.columns = static_cast<int>(columns.size());
  grid.rows = rows_of(part);
  for (int r = 0; r < grid.rows; ++r) {
    const double t = static_cast<double>(r) / (grid.rows - 1);
    for (const double x : columns)
      grid.points.push_back(bind({x, (1 - t) * top_of(part, x) + t * bottom_of(part, x)}, part));
  }
  return grid;
}

void CanvasMap::add(const Grid& grid, const std::vector<Point>& placed) {
  const auto corner = [&](int r, int c) {
    const auto i = static_cast<std::size_t>(r * grid.columns + c);
    return Corner{placed[i], grid.points[i].rest};
  };
  // From the bottom, so that the chin hides the neck that it sinks upon.
  for (int r = grid.rows - 2; r >= 0; --r)
    for (int c = 0; c + 1 < grid.columns; ++c)
      quad(corner(r, c), corner(r, c + 1), corner(r + 1, c + 1), corner(r + 1, c));
}

void CanvasMap::close_gap(const Grid& above, const std::vector<Point>& upper, const Grid& below,
                          const std::vector<Point>& lower) {
  const auto last = static_cast<std::size_t>((above.rows - 1) * above.columns);
  for (std::size_t c = 0; c + 1 < static_cast<std::size_t>(above.columns); ++c) {
    const Corner a{upper[last + c], above.points[last + c].rest},
        b{upper[last + c + 1], above.points[last + c + 1].rest};
    const Corner d{lower[c], below.points[c].rest}, e{lower[c + 1], below.points[c + 1].rest};
    if ((a.at - d.at).norm() + (b.at - e.at).norm() > 1e-9) quad(a, b, e, d);
  }
}

void CanvasMap::quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void CanvasMap::triangle(const Corner& a, const Corner& b, const Corner& c) {
  const auto pixel = [&](const Point& p) -> Point { return p * scale_ - Point(0.5, 0.5); };
  const Point pa = pixel(a.at), pb = pixel(b.at), pc = pixel(c.at);
  const double whole = area(pa, pb, pc);
  if (std::abs(whole) < 1e-12) return;
  const int left = std::max(0, static_cast<int>(std::ceil(std::min({pa.x(), pb.x(), pc.x()}) - 1e-6)));
  const int right = std::min(map_.cols - 1, static_cast<int>(std::floor(std::max({pa.x(), pb.x(), pc.x()}) + 1e-6)));
  const int top = std::max(0, static_cast<int>(std::ceil(std::min({pa.y(), pb.y(), pc.y()}) - 1e-6)));
  const int bottom = std::min(map_.rows - 1, static_cast<int>(std::floor(std::max({pa.y(), pb.y(), pc.y()}) + 1e-6)));
  constexpr double edge = -1e-6;  // pixels on an edge belong to both triangles
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const Point p(x, y);
      const double wb = area(pa, p, pc) / whole, wc = area(pa, pb, p) / whole, wa = 1 - wb - wc;
      if (wa < edge || wb < edge || wc < edge) continue;
      const Point shows = wa * a.shows + wb * b.shows + wc * c.shows;
      map_(y, x) = {static_cast<float>(shows.x()), static_cast<float>(shows.y())};
    }
}

}  // namespace talkgraph::face
