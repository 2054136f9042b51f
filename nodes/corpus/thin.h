#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// Keeps at most `most` recordings of each of some splits, spread evenly over
/// it; all others pass, in their order. The same recordings are kept each time.
/// Throws std::runtime_error, with the splits that there are, if one named has
/// no recording.
struct Thin {
  std::vector<std::string> splits;  ///< empty: each
  int most = 50;

  Stream<Recording> operator()(const Collected<Recording>& recordings) const;
};
void describe(Description<Thin>& d);

}  // namespace talkgraph
