#include "nodes/plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace talkgraph {

std::vector<double> Axis::ticks() const {
  std::vector<double> all;
  const auto n = std::lround((high - low) / step);
  for (long i = 0; i <= n; ++i) all.push_back(low + static_cast<double>(i) * step);
  return all;
}

Axis axis_over(double low, double high, int ticks) {
  if (!(low <= high)) low = 0, high = 1;
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * size || high == low) low -= std::max(0.5 * size, 0.5), high += std::max(0.5 * size, 0.5);
  const double raw = (high - low) / ticks, power = std::pow(10, std::floor(std::log10(raw)));
  const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
  return {std::floor(low / step) * step, std::ceil(high / step) * step, step};
}

std::string tick_text(const Axis& axis, double v) {
  return fmt::format("{:.4g}", std::abs(v) < axis.step / 1e6 ? 0.0 : v);
}

}  // namespace talkgraph
