#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/statistics/correction.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Compares scores of groups that have nothing to do with each other, as of different people or recordings, by
/// Wilcoxon's rank-sum test (rank_sum.h); rows are not paired, and need not be the same or as many. Throws
/// std::runtime_error if the tables' columns differ, a row is there twice, or a score is infinite or unknown.
struct CompareGroups {
  std::vector<std::string> scores = {};  ///< columns, in their order; empty: all
  int exact_up_to = 50;
  Correction correction = Correction::holm;
  std::string title = "Groups";

  /// A row a pair "A - B" of groups. Of each score:
  ///   x         difference of the means
  ///   x p       of the test, corrected over the pairs for this score; NaN where a group has no value
  ///   x effect  rank-biserial correlation: 1 if every score of A is above every one of B
  Table operator()(const Collected<Table>& groups) const;
};
void describe(Description<CompareGroups>& d);

}  // namespace talkgraph
