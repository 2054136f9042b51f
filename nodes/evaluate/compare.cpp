#include "nodes/evaluate/compare.h"

#include <stdexcept>

namespace talkgraph {

Table Compare::operator()(const Collected<Table>& tables) const {
  Table out;
  out.title = title;
  out.corner = corner;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (i == 0) out.columns = tables[i].columns;
    if (tables[i].columns != out.columns)
      throw std::runtime_error("tables \"" + tables.key(0) + "\" and \"" + tables.key(i) + "\" have different columns");
    for (std::size_t r = 0; r < tables[i].rows.size(); ++r) {
      out.rows.push_back(tables[i].rows.size() == 1 ? tables.key(i) : tables.key(i) + ": " + tables[i].rows[r]);
      out.cells.push_back(tables[i].cells[r]);
    }
  }
  return out;
}

void describe(Description<Compare>& d) {
  d.type("evaluate.compare").summary("one table of all methods");
  d.input("tables", "an object of named tables").output("table", "a row for each of them");
  d.param("title", &Compare::title).doc("heading of the table");
  d.param("corner", &Compare::corner).doc("heading of the row names");
}

}  // namespace talkgraph
