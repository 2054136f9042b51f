#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Columns of a table as lines over its rows, counted from 1. Throws
/// std::runtime_error if a column is missing.
struct PlotCurves {
  std::vector<std::string> columns;  ///< empty: all
  std::string title;                 ///< empty: the table's
  std::string y_label;
  bool log10 = false;  ///< common logarithms of the values; those not above 0 are left out

  Plot operator()(const Table& table) const;
};
void describe(Description<PlotCurves>& d);

}  // namespace talkgraph
