#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Columns of a table as bars, a panel a column and a bar a row, with whiskers
/// from the column "NAME std" where there is one. Throws std::runtime_error if
/// a column is missing.
struct PlotBars {
  std::vector<std::string> columns = {"acc", "amse_share"};

  Plot operator()(const Table& table) const;
};
void describe(Description<PlotBars>& d);

}  // namespace talkgraph
