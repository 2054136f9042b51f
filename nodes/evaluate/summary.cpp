#include "nodes/evaluate/summary.h"

#include <cmath>

namespace talkgraph {

Table Summary::operator()(const Collected<Scores>& all) const {
  Table table;
  table.rows = {"all"};
  table.cells.resize(1);
  for (const auto& name : scores) {
    std::vector<double> values;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (const auto it = all[i].values.find(name); it != all[i].values.end() && !std::isnan(it->second))
        values.push_back(it->second);
    double mean = 0, square = 0;
    const auto n = static_cast<double>(values.size());
    for (const double v : values) mean += v / n;
    for (const double v : values) square += (v - mean) * (v - mean);
    table.columns.push_back(name);
    table.cells[0].push_back(values.empty() ? NAN : mean);
    table.columns.push_back(name + " std");
    table.cells[0].push_back(n > 1 ? std::sqrt(square / (n - 1)) : NAN);
  }
  table.columns.emplace_back("sequences");
  table.cells[0].push_back(static_cast<double>(all.size()));
  return table;
}

void describe(Description<Summary>& d) {
  d.type("evaluate.summary").summary("mean and standard deviation of scores over sequences").source("Thesis §6.2");
  d.input("scores", "of each sequence")
      .output("table", "one row; of each score x: x, x std; sequences: how many there are");
  d.param("scores", &Summary::scores)
      .doc("which, in the order of the columns; one that no sequence has is an empty column");
}

}  // namespace talkgraph
