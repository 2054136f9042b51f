#pragma once

#include <string>
#include <vector>

namespace talkgraph {

/// Round limits around some values, and the distance of the ticks between them.
struct Axis {
  double low = 0, high = 1, step = 1;

  double share(double v) const { return (v - low) / (high - low); }
  std::vector<double> ticks() const;
};

/// The axis from `low` to `high` with about `ticks` ticks. Equal or unordered
/// limits give a unit axis around them.
Axis axis_over(double low, double high, int ticks);

/// A tick's value as short as it can be written.
std::string tick_text(const Axis& axis, double v);

}  // namespace talkgraph
