#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace talkgraph {

enum class Edit : char { pair, missing, extra };

/// Steps of the cheapest way from a sequence of n to one of m elements, the last first. An element that is missing from
/// the second, or extra in it, costs `gap`; pair(i, j) is what taking element j for element i costs. Of equals a pair,
/// then a missing one.
template <class Pair>
std::vector<Edit> edit_path(std::size_t n, std::size_t m, int gap, Pair pair) {
  std::vector<Edit> steps((n + 1) * (m + 1), Edit::extra);
  std::vector<int> row(m + 1), above(m + 1);
  for (std::size_t j = 0; j <= m; ++j) row[j] = gap * static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i) {
    std::swap(row, above);
    row[0] = above[0] + gap;
    steps[i * (m + 1)] = Edit::missing;
    for (std::size_t j = 1; j <= m; ++j) {
      const int paired = above[j - 1] + pair(i - 1, j - 1), missing = above[j] + gap, extra = row[j - 1] + gap;
      row[j] = std::min({paired, missing, extra});
      steps[i * (m + 1) + j] = row[j] == paired ? Edit::pair : row[j] == missing ? Edit::missing : Edit::extra;
    }
  }
  std::vector<Edit> path;
  for (std::size_t i = n, j = m; i + j > 0;) {
    path.push_back(steps[i * (m + 1) + j]);
    i -= path.back() != Edit::extra;
    j -= path.back() != Edit::missing;
  }
  return path;
}

}  // namespace talkgraph
