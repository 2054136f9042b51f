#include "nodes/statistics/ranks.h"

#include <algorithm>
#include <numeric>

namespace talkgraph {

Ranks ranks_of(const std::vector<double>& values, double rounding) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  Ranks ranks{std::vector<std::size_t>(values.size()), 0};
  for (std::size_t from = 0, to = 0; from < order.size(); from = to) {
    while (to < order.size() && values[order[to]] - values[order[from]] <= rounding) ++to;
    for (std::size_t i = from; i < to; ++i) ranks.doubled[order[i]] = from + 1 + to;
    const auto t = static_cast<double>(to - from);
    ranks.ties += t * t * t - t;
  }
  return ranks;
}

}  // namespace talkgraph
