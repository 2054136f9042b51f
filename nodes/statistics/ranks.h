#pragma once

#include <cstddef>
#include <vector>

namespace talkgraph {

/// Ranks of values, from 1, doubled: whole numbers where equal values share their mean rank. Values up to `rounding`
/// above the least of a group are equal to it.
struct Ranks {
  std::vector<std::size_t> doubled;
  double ties = 0;  ///< Σ t³ − t over groups of t equal values
};
Ranks ranks_of(const std::vector<double>& values, double rounding = 0);

}  // namespace talkgraph
