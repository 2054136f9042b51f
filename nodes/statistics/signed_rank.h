#pragma once

#include <cstddef>
#include <vector>

namespace talkgraph {

/// Wilcoxon's signed-rank test of paired values.
struct SignedRank {
  std::size_t pairs = 0;  ///< that differ
  double statistic = 0;   ///< the smaller of the rank sums of positive and of negative differences
  double p = 1;           ///< two-sided
  double effect = 0;  ///< matched-pairs rank-biserial correlation, (W₊ − W₋) / (W₊ + W₋); 0 if no pair differs
  bool exact = true;  ///< p is not of the normal approximation
};

/// Are differences as often and as far above 0 as below? Differences of 0 are left out (Wilcoxon 1945), sizes that are
/// equal but for rounding share their mean rank. Up to `exact_up_to` pairs p is exact: of all 2ⁿ choices of signs,
/// given the ranks as they are, ties included; above it is that of the normal approximation with the variance corrected
/// for ties, without continuity correction. p is 1 if no pair differs. Throws std::invalid_argument on a difference
/// that is not finite.
SignedRank signed_rank(const std::vector<double>& differences, std::size_t exact_up_to = 50);

}  // namespace talkgraph
