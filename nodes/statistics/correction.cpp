#include "nodes/statistics/correction.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {

std::vector<double> corrected(const std::vector<double>& p, Correction correction) {
  std::vector<std::size_t> order;  // of the tests, by rising p
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!std::isnan(p[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> out = p;
  const auto m = static_cast<double>(order.size());
  if (correction == Correction::holm) {
    double least = 0;
    for (std::size_t k = 0; k < order.size(); ++k)
      out[order[k]] = least = std::max(least, std::min(1.0, (m - static_cast<double>(k)) * p[order[k]]));
  } else if (correction == Correction::benjamini_hochberg) {
    double most = 1;
    for (std::size_t k = order.size(); k-- > 0;)
      out[order[k]] = most = std::min(most, m / static_cast<double>(k + 1) * p[order[k]]);
  }
  return out;
}

}  // namespace talkgraph
