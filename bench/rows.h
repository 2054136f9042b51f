#pragma once

#include <functional>
#include <string>
#include <vector>

namespace talkgraph::bench {

inline constexpr int rounds = 5;

/// One line of a table: something whose processor time is measured.
struct Row {
  std::string name;
  std::function<double()> measure;  ///< seconds of processor time
  std::vector<double> seen = {};    ///< least first

  double median() const { return seen[seen.size() / 2]; }
};

/// Measures work of this process.
std::function<double()> own(std::function<void()> work);

/// Measures all rows again and again in turn, so that a busy spell of the machine meets all of them.
void measure(std::vector<Row>& rows);

}  // namespace talkgraph::bench
