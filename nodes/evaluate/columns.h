#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Some columns of a table, in this order, each with those about it that follow: "acc" takes "acc std" and "acc p" too.
/// Throws std::runtime_error if the table lacks a column.
struct PickColumns {
  std::vector<std::string> columns;
  std::string title = {};  ///< empty: the table's

  Table operator()(const Table& table) const;
};
void describe(Description<PickColumns>& d);

}  // namespace talkgraph
