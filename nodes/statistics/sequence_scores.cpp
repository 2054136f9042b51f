#include "nodes/statistics/sequence_scores.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace talkgraph {

SequenceScores sequence_scores(const Table& table, const std::string& score) {
  const auto column =
      static_cast<std::size_t>(std::find(table.columns.begin(), table.columns.end(), score) - table.columns.begin());
  SequenceScores scores;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const double value = table.cells[r].at(column);
    if (std::isinf(value)) throw std::runtime_error(fmt::format("{} of \"{}\" is infinite", score, table.rows[r]));
    if (!std::isnan(value)) scores[table.rows[r]] = value;
  }
  return scores;
}

std::vector<double> values_of(const SequenceScores& scores) {
  std::vector<double> values;
  for (const auto& [sequence, value] : scores) values.push_back(value);
  return values;
}

std::vector<double> paired_differences(const SequenceScores& a, const SequenceScores& b) {
  std::vector<double> differences;
  for (const auto& [sequence, value] : a)
    if (const auto other = b.find(sequence); other != b.end())
      differences.push_back(same_score(value, other->second) ? 0 : value - other->second);
  return differences;
}

std::vector<std::string> scores_of(const Collected<Table>& methods, const std::vector<std::string>& wanted) {
  if (methods.empty()) return wanted;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (methods[i].columns != methods[0].columns)
      throw std::runtime_error(fmt::format("the tables of \"{}\" and \"{}\" have different columns: {}; {}",
                                           methods.key(0), methods.key(i), fmt::join(methods[0].columns, ", "),
                                           fmt::join(methods[i].columns, ", ")));
    std::set<std::string> seen;
    for (const auto& sequence : methods[i].rows)
      if (!seen.insert(sequence).second)
        throw std::runtime_error(fmt::format("\"{}\" has the sequence \"{}\" twice", methods.key(i), sequence));
  }
  for (const auto& score : wanted)
    if (std::find(methods[0].columns.begin(), methods[0].columns.end(), score) == methods[0].columns.end())
      throw std::runtime_error(
          fmt::format("the tables have no score \"{}\"; they have {}", score, fmt::join(methods[0].columns, ", ")));
  return wanted.empty() ? methods[0].columns : wanted;
}

}  // namespace talkgraph
