#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "graph/value.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// One score of each sequence that has it, by the sequence's name.
using SequenceScores = std::map<std::string, double>;
SequenceScores sequence_scores(const Table& table, const std::string& score);

std::vector<double> values_of(const SequenceScores& scores);

/// Whether two scores differ by no more than rounding; false of NaN.
inline bool same_score(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }

/// a − b of each sequence that has both, 0 if they are the same.
std::vector<double> paired_differences(const SequenceScores& a, const SequenceScores& b);

/// `wanted`, or all columns if it is empty. Throws std::runtime_error if the tables' columns differ, one that is wanted
/// is not there, or a sequence is there twice.
std::vector<std::string> scores_of(const Collected<Table>& methods, const std::vector<std::string>& wanted);

}  // namespace talkgraph
