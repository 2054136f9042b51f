#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace talkgraph {

/// A dot with a whisker from `low` to `high`; NaN leaves either out.
struct Dot {
  double value = NAN, low = NAN, high = NAN;
};

/// Named rows under each other, a dot a series in each, along one axis.
struct DotPanel {
  struct Row {
    std::string name;
    std::vector<Dot> dots;
  };
  std::string title, x_label;
  double from = 0, to = 1;  ///< ends of the axis
  double reference = NAN;   ///< a dashed line there, such as chance
  int decimals = 0;         ///< of the values written
  std::vector<Row> rows;
};

/// Panels beside and under each other with one legend for all; values are written beside the rows, the rows' names once
/// where panels beside each other have the same. SVG text that stands
/// alone or inside HTML; screen readers are told the title.
std::string draw_dots(const std::string& title, const std::vector<std::string>& series,
                      const std::vector<DotPanel>& panels, int columns = 2);

}  // namespace talkgraph
