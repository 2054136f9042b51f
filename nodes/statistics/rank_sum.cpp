#include "nodes/statistics/rank_sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "nodes/statistics/ranks.h"

namespace talkgraph {
namespace {

/// Of all choices of `chosen` ranks twice the share whose sum is at most `doubled_sum`, or at least, whichever is less.
double exact_p(const std::vector<std::size_t>& doubled, std::size_t chosen, std::size_t doubled_sum) {
  const std::size_t most = std::accumulate(doubled.begin(), doubled.end(), std::size_t{0});
  // ways[k][s]: to choose k of the ranks so far with sum s.
  std::vector<std::vector<double>> ways(chosen + 1, std::vector<double>(most + 1, 0));
  ways[0][0] = 1;
  std::size_t reached = 0;
  for (const std::size_t r : doubled) {
    reached += r;
    for (std::size_t k = chosen; k > 0; --k)
      for (std::size_t s = r; s <= reached; ++s) ways[k][s] += ways[k - 1][s - r];
  }
  const auto& all = ways[chosen];
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(doubled_sum);
  const double below = std::accumulate(all.begin(), at + 1, 0.0), above = std::accumulate(at, all.end(), 0.0);
  return std::min(1.0, 2 * std::min(below, above) / (below + above - *at));
}

double normal_p(double statistic, double n, double m, double ties) {
  const double all = n + m, variance = n * m / 12 * (all + 1 - ties / (all * (all - 1)));
  if (variance <= 0) return 1;
  const double distance = std::abs(statistic - n * m / 2) - 0.5;
  return std::min(1.0, std::erfc(distance / std::sqrt(2 * variance)));
}

}  // namespace

RankSum rank_sum(const std::vector<double>& a, const std::vector<double>& b, std::size_t exact_up_to) {
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  if (!std::all_of(all.begin(), all.end(), [](double v) { return std::isfinite(v); }))
    throw std::invalid_argument("values must be finite");
  if (a.empty() || b.empty()) return {.p = NAN, .effect = NAN};
  const Ranks ranks = ranks_of(all);
  const auto of_b = ranks.doubled.begin() + static_cast<std::ptrdiff_t>(a.size());
  const std::size_t sum_a = std::accumulate(ranks.doubled.begin(), of_b, std::size_t{0}),
                    sum_b = std::accumulate(of_b, ranks.doubled.end(), std::size_t{0});
  const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  RankSum test;
  test.statistic = static_cast<double>(sum_a) / 2 - n * (n + 1) / 2;
  test.effect = 2 * test.statistic / (n * m) - 1;
  test.exact = all.size() <= exact_up_to;
  test.p = !test.exact            ? normal_p(test.statistic, n, m, ranks.ties)
           : a.size() <= b.size() ? exact_p(ranks.doubled, a.size(), sum_a)
                                  : exact_p(ranks.doubled, b.size(), sum_b);
  return test;
}

}  // namespace talkgraph
