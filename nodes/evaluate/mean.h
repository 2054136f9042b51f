#pragma once

#include "nodes/types/report.h"

namespace talkgraph {

/// The mean of some values, as a score.
class Mean {
 public:
  void add(double value, double weight = 1) {
    sum_ += weight * value;
    weights_ += weight;
  }
  /// In these units; no score if nothing was added.
  void store(Scores& scores, const char* name, double unit = 1) const {
    if (weights_ > 0) scores.values[name] = sum_ / weights_ / unit;
  }

 private:
  double sum_ = 0, weights_ = 0;
};

}  // namespace talkgraph
