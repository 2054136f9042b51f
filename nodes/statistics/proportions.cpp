#include "nodes/statistics/proportions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/statistics/intervals.h"

namespace talkgraph {
namespace {

std::size_t place_of(const std::vector<std::string>& names, const std::string& name, const char* what) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end())
    throw std::runtime_error(fmt::format("the table has no {} \"{}\"; it has {}", what, name, fmt::join(names, ", ")));
  return static_cast<std::size_t>(it - names.begin());
}

std::size_t count_of(const Table& table, std::size_t row, std::size_t column) {
  const double value = table.cells[row].at(column);
  if (!(value >= 0 && value < 1e15 && value == std::floor(value)))
    throw std::runtime_error(
        fmt::format("{} of \"{}\" is {}, which is no count", table.columns[column], table.rows[row], value));
  return static_cast<std::size_t>(value);
}

}  // namespace

double cohens_h(double a, double b) { return 2 * (std::asin(std::sqrt(a)) - std::asin(std::sqrt(b))); }

Table Proportions::operator()(const Table& counts) const {
  const auto parts = place_of(counts.columns, part, "column"), wholes = place_of(counts.columns, whole, "column");
  Table out{title, counts.corner, {"share", "share low", "share high"}, counts.rows, {}};
  for (std::size_t r = 0; r < counts.rows.size(); ++r) {
    const auto n = count_of(counts, r, parts), all = count_of(counts, r, wholes);
    if (n > all)
      throw std::runtime_error(fmt::format("\"{}\" has {} {} of {} {}", counts.rows[r], n, part, all, whole));
    const auto [low, high] = wilson_interval(n, all, confidence);
    out.cells.push_back({static_cast<double>(n) / static_cast<double>(all), low, high});
  }
  if (against.empty()) return out;
  const double other = out.cells[place_of(counts.rows, against, "row")][0];
  out.columns.emplace_back("h");
  for (auto& cells : out.cells) cells.push_back(cohens_h(cells[0], other));
  return out;
}

void describe(Description<Proportions>& d) {
  d.type("statistics.proportions").summary("shares of counts with Wilson's confidence intervals and effect sizes");
  d.source("Wilson 1927; Cohen 1988");
  d.input("counts", "a row a share");
  d.output("table", "the same rows: share, share low, share high; h, Cohen's effect size against one of them");
  d.param("part", &Proportions::part).required().doc("column of counts");
  d.param("whole", &Proportions::whole).required().doc("column of what they are parts of");
  d.param("against", &Proportions::against).doc("row that h compares with; empty: no h");
  d.param("confidence", &Proportions::confidence).within(0.5, 0.999).doc("of the intervals");
  d.param("title", &Proportions::title).doc("heading of the table");
}

}  // namespace talkgraph
