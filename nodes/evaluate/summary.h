#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// One row of a table: mean and standard deviation over sequences of each
/// score, and the number of sequences. NaN scores are left out.
struct Summary {
  std::vector<std::string> scores = {"acc", "amse", "amse_share", "range"};  ///< columns

  Table operator()(const Collected<Scores>& all) const;
};
void describe(Description<Summary>& d);

}  // namespace talkgraph
