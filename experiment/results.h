#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "runtime/executor.h"

namespace talkgraph {

/// One number of one trial.
struct Observation {
  std::string output;   ///< of the graph
  std::string item;     ///< key, where the output is a stream
  std::string row;      ///< of a table; empty for scores
  std::string measure;  ///< column of a table, name of a score
  double value = 0;
};

/// A clip or picture of a trial.
struct Shown {
  std::string output, item;
  Value value;  ///< an Artifact, its path relative to the run folder, or a Plot
};

/// What came of one trial.
struct TrialResult {
  enum class Status { waiting, finished, failed, stopped };
  Status status = Status::waiting;
  std::string error;         ///< what stopped it; of items that failed, the first
  std::size_t failures = 0;  ///< items
  double wall = 0;           ///< seconds
  std::uint64_t calls = 0;   ///< of nodes
  std::uint64_t loaded = 0;  ///< results found
  std::vector<Observation> observations;
  std::vector<Shown> shown;
};
const char* status_text(TrialResult::Status status);

/// The numbers of the outputs that are to be tabulated; cells without a value are left out.
std::vector<Observation> observe(const Experiment& experiment, const RunResult& run);
/// The clips and pictures of the outputs that are to be shown.
std::vector<Shown> pick_shown(const Experiment& experiment, const RunResult& run);

/// A mean over repeats, with its standard deviation and its 95 % confidence interval by Student's t; where there is one
/// trial only, over the items of a stream. A single number of a table has those and the p that the table has of it
/// ("acc std", "acc low", "acc high", "acc p").
struct Estimate {
  enum class Over { repeats, items, table };
  std::size_t setting = 0;
  std::string output, row, measure;
  std::size_t n = 0;          ///< numbers that the mean is of
  Over over = Over::repeats;  ///< what deviation and interval are over
  bool partial = false;       ///< some items of the trials failed
  double mean = 0;
  double deviation = NAN;        ///< NaN where there is none
  double low = NAN, high = NAN;  ///< ends of the interval; NaN where there is none
  double p = NAN;                ///< of a test; NaN where there is none
};

/// By setting, output, row, measure, in the order in which they came. What stands beside a measure of its output
/// ("acc std", "acc low") is no measure of its own.
std::vector<Estimate> estimate(const Experiment& experiment, const std::vector<TrialResult>& results);

/// One line a number: trial, factors, seed, status, output, item, row, measure, value.
std::string tidy_csv(const Experiment& experiment, const std::vector<TrialResult>& results);
Json tidy_json(const Experiment& experiment, const std::vector<TrialResult>& results);
/// One line an estimate: factors, output, row, measure, n, over, partial, mean, std, low, high, p.
std::string estimates_csv(const Experiment& experiment, const std::vector<Estimate>& estimates);

}  // namespace talkgraph
