#include "nodes/evaluate/columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace talkgraph {

Table PickColumns::operator()(const Table& table) const {
  Table out{title.empty() ? table.title : title, table.corner, {}, table.rows, {}};
  out.cells.resize(table.rows.size());
  for (const auto& name : columns) {
    if (std::find(table.columns.begin(), table.columns.end(), name) == table.columns.end())
      throw std::runtime_error(
          fmt::format("the table has no column \"{}\"; it has {}", name, fmt::join(table.columns, ", ")));
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c] != name && !table.columns[c].starts_with(name + " ")) continue;
      out.columns.push_back(table.columns[c]);
      for (std::size_t r = 0; r < table.rows.size(); ++r) out.cells[r].push_back(table.cells[r][c]);
    }
  }
  return out;
}

void describe(Description<PickColumns>& d) {
  d.type("evaluate.columns").summary("some columns of a table, with their deviations, intervals and p-values");
  d.input("table", "as statistics.methods gives it").output("table", "the same rows");
  d.param("columns", &PickColumns::columns).doc("which, in this order; \"acc\" takes \"acc std\" along");
  d.param("title", &PickColumns::title).doc("heading; empty: the table's");
}

}  // namespace talkgraph
