#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// One table of all methods: the rows of the given tables under each other,
/// named by the names they are wired under. Columns must agree.
struct Compare {
  std::string title = "scores";
  std::string corner = "method";

  Table operator()(const Collected<Table>& tables) const;
};
void describe(Description<Compare>& d);

}  // namespace talkgraph
