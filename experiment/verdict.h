#pragma once

#include <string>
#include <vector>

#include "experiment/results.h"

namespace talkgraph {

/// Who is best in one setting by one score.
struct Verdict {
  struct Close {
    std::string row;
    double behind = 0;
  };
  std::size_t setting = 0;
  std::string score;         ///< "acc"
  std::string best;          ///< the row whose mean is best
  double won = NAN;          ///< recordings in which no other row is better; NaN where that is not known
  std::size_t beaten = 0;    ///< rows that it is significantly ahead of, p below 0.05
  std::vector<Close> close;  ///< the others
};

/// Verdicts of one output, whose measures "x behind" and "x won" are those of statistics.methods (`best`); none where
/// it has no such measures, or no test, as means over repeats have none. In the order of settings, then of scores.
std::vector<Verdict> verdicts(const std::vector<const Estimate*>& estimates);

}  // namespace talkgraph
