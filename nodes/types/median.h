#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace talkgraph {

/// The middle of the values, which it reorders; between the two middle ones of an even number; NaN of none.
inline double median(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace talkgraph
