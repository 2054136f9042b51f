#pragma once

#include <string>

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// How far two shares lie apart, 2 asin √a − 2 asin √b: 0.2 is small, 0.5 medium, 0.8 large (Cohen 1988).
double cohens_h(double a, double b);

/// Shares of counts with their intervals (wilson_interval in intervals.h). Throws std::runtime_error if a column or the
/// row `against` is not there, or a count is no whole number, below 0 or above what it is a part of.
struct Proportions {
  std::string part;   ///< column of counts
  std::string whole;  ///< column of what they are parts of
  std::string against = {};
  double confidence = 0.95;
  std::string title = "Shares";

  /// Its rows, with the columns share, share low, share high and, unless `against` is empty, h: Cohen's h against that
  /// row. NaN of nothing.
  Table operator()(const Table& counts) const;
};
void describe(Description<Proportions>& d);

}  // namespace talkgraph
