#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// The scores of each sequence, a row each, named by its key. NaN where a
/// sequence lacks a score.
struct SequenceTable {
  std::vector<std::string> scores = {"acc", "amse", "amse_share", "range"};  ///< columns
  std::string title = "Scores of each sequence";

  Table operator()(const Collected<Scores>& all) const;
};
void describe(Description<SequenceTable>& d);

}  // namespace talkgraph
