#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "nodes/speaker/face.h"

namespace talkgraph::face {

/// A grid of bound points over one part of the canvas, row by row; its first
/// and last rows lie on the cuts.
struct Grid {
  int rows = 0, columns = 0;
  std::vector<Bound> points;

  std::vector<Point> placed(const Movement& movement) const;
};
Grid make_grid(Part part);

/// For every pixel of a picture the point of the canvas that it shows: two
/// channels, in units. `scale` is pixels per unit.
class CanvasMap {
 public:
  CanvasMap(cv::Size size, double scale) : map_(size, cv::Vec2f(0, 0)), scale_(scale) {}

  void add(const Grid& grid, const std::vector<Point>& placed);
  /// Closes the gap between the last row of the part above and the first of
  /// the part below with the colours of the cut.
  void close_gap(const Grid& above, const std::vector<Point>& upper, const Grid& below,
                 const std::vector<Point>& lower);
  const cv::Mat2f& map() const { return map_; }

 private:
  struct Corner {
    Point at, shows;
  };
  void triangle(const Corner& a, const Corner& b, const Corner& c);
  void quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d);

  cv::Mat2f map_;
  double scale_;
};

}  // namespace talkgraph::face
