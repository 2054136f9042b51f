#pragma once

#include <cstddef>
#include <vector>

namespace talkgraph {

/// Wilcoxon's rank-sum test of two independent samples, which is Mann and Whitney's U test.
struct RankSum {
  double statistic = 0;  ///< U: pairs (a, b) with a > b, half of those with a = b
  double p = 1;          ///< two-sided; NaN if a sample is empty
  double effect = 0;     ///< rank-biserial correlation, share of pairs with a > b less that with a < b; NaN as p
  bool exact = true;     ///< p is not of the normal approximation

  /// Vargha and Delaney's A: how likely one of a is above one of b, ties counted half.
  double superiority() const { return (1 + effect) / 2; }
};

/// Does one sample tend to larger values than the other? Equal values share their mean rank. Up to `exact_up_to`
/// values in all p is exact: twice the smaller tail, over all ways to choose which of the ranks, as they are, ties
/// included, are a's. Above, it is that of the normal approximation with the variance corrected for ties and with
/// continuity correction. p is 1 if all values are equal. Throws std::invalid_argument on a value that is not finite.
/// Wilcoxon 1945; Mann & Whitney 1947; Vargha & Delaney 2000.
RankSum rank_sum(const std::vector<double>& a, const std::vector<double>& b, std::size_t exact_up_to = 50);

}  // namespace talkgraph
