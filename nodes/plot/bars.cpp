#include "nodes/plot/bars.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/plot/svg.h"

namespace talkgraph {
namespace {

std::ptrdiff_t column_of(const Table& table, const std::string& name) {
  const auto it = std::find(table.columns.begin(), table.columns.end(), name);
  return it == table.columns.end() ? -1 : it - table.columns.begin();
}

}  // namespace

Plot PlotBars::operator()(const Table& table) const {
  std::vector<BarPanel> panels;
  for (const auto& name : columns) {
    const auto value = column_of(table, name), spread = column_of(table, name + " std");
    if (value < 0)
      throw std::runtime_error(
          fmt::format("the table has no column \"{}\" to draw; it has {}", name, fmt::join(table.columns, ", ")));
    BarPanel panel{name, {}};
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const auto& cells = table.cells[r];
      panel.bars.push_back({table.rows[r], cells[static_cast<std::size_t>(value)],
                            spread < 0 ? NAN : cells[static_cast<std::size_t>(spread)]});
    }
    panels.push_back(std::move(panel));
  }
  return {table.title, draw_bars(table.title, panels)};
}

void describe(Description<PlotBars>& d) {
  d.type("plot.bars").version(2).summary("columns of a table as bars, with whiskers of one standard deviation");
  d.input("table", "as evaluate.compare gives it").output("plot", "a panel a column");
  d.param("columns", &PlotBars::columns).doc("which, a panel each");
}

}  // namespace talkgraph
