#include "nodes/plot/curves.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/plot/svg.h"

namespace talkgraph {

Plot PlotCurves::operator()(const Table& table) const {
  Panel panel{"", table.corner, y_label, {}};
  for (const auto& name : columns.empty() ? table.columns : columns) {
    const auto column = std::find(table.columns.begin(), table.columns.end(), name) - table.columns.begin();
    if (column == std::ssize(table.columns))
      throw std::runtime_error(
          fmt::format("the table has no column \"{}\" to draw; it has {}", name, fmt::join(table.columns, ", ")));
    auto& line = panel.series.emplace_back(Series{name, {}, {}});
    for (std::size_t r = 0; r < table.cells.size(); ++r) {
      line.x.push_back(static_cast<double>(r + 1));
      const double value = table.cells[r][static_cast<std::size_t>(column)];
      line.y.push_back(!log10 ? value : value > 0 ? std::log10(value) : NAN);
    }
  }
  const auto& heading = title.empty() ? table.title : title;
  return {heading, draw_panels(heading, {panel}, {1, 640, 320})};
}

void describe(Description<PlotCurves>& d) {
  d.type("plot.curves").version(1).summary("columns of a table as lines over its rows");
  d.input("table", "with a row a step: the variances of face.report, say").output("plot", "one panel");
  d.param("columns", &PlotCurves::columns).doc("which, a line each; empty: all");
  d.param("title", &PlotCurves::title).doc("empty: the table's");
  d.param("y_label", &PlotCurves::y_label).doc("what the values are");
  d.param("log10", &PlotCurves::log10).doc("common logarithms of the values; those not above 0 are left out");
}

}  // namespace talkgraph
