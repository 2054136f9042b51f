#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/recording.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// How many recordings each split has, a row a split. Throws std::runtime_error
/// with the splits that there are if one of `train`, or `evaluate`, has none: a
/// misspelt name would otherwise leave nothing to learn from or to score, and
/// if `evaluate` is trained on, which would make its scores worthless.
struct Splits {
  std::vector<std::string> train;
  std::string evaluate;  ///< empty: nothing is scored

  Table operator()(const Collected<Recording>& recordings) const;
};
void describe(Description<Splits>& d);

}  // namespace talkgraph
