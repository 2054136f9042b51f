#include "nodes/statistics/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "nodes/statistics/ranks.h"

namespace talkgraph {
namespace {

/// Twice the share of all choices of signs whose positive ranks sum to `doubled_sum` or less, at most 1.
double exact_p(const std::vector<std::size_t>& doubled, std::size_t doubled_sum) {
  std::vector<double> shares(doubled_sum + 1, 0);  // of sums of the ranks so far
  shares[0] = 1;
  for (const std::size_t r : doubled)
    for (std::size_t s = shares.size(); s-- > 0;) shares[s] = 0.5 * (shares[s] + (s >= r ? shares[s - r] : 0));
  return std::min(1.0, 2 * std::accumulate(shares.begin(), shares.end(), 0.0));
}

double normal_p(double statistic, double n, double ties) {
  const double mean = n * (n + 1) / 4, variance = n * (n + 1) * (2 * n + 1) / 24 - ties / 48;
  return std::erfc(std::abs(statistic - mean) / std::sqrt(2 * variance));
}

}  // namespace

SignedRank signed_rank(const std::vector<double>& differences, std::size_t exact_up_to) {
  std::vector<double> unequal;
  for (const double d : differences) {
    if (!std::isfinite(d)) throw std::invalid_argument("differences must be finite");
    if (d != 0) unequal.push_back(d);
  }
  SignedRank test{.pairs = unequal.size()};
  if (unequal.empty()) return test;
  std::vector<double> sizes;
  for (const double d : unequal) sizes.push_back(std::abs(d));
  const Ranks ranks = ranks_of(sizes, 1e-12 * *std::max_element(sizes.begin(), sizes.end()));
  std::size_t above = 0, below = 0;  // doubled
  for (std::size_t i = 0; i < unequal.size(); ++i) (unequal[i] > 0 ? above : below) += ranks.doubled[i];
  const std::size_t least = std::min(above, below);
  test.statistic = static_cast<double>(least) / 2;
  test.effect = (static_cast<double>(above) - static_cast<double>(below)) / static_cast<double>(above + below);
  test.exact = unequal.size() <= exact_up_to;
  test.p = test.exact ? exact_p(ranks.doubled, least)
                      : normal_p(test.statistic, static_cast<double>(unequal.size()), ranks.ties);
  return test;
}

}  // namespace talkgraph
