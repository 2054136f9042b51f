#include "nodes/corpus/splits.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "graph/json.h"

namespace talkgraph {

Table Splits::operator()(const Collected<Recording>& recordings) const {
  Table table{"Recordings of each split", "split", {"recordings"}, {}, {}};
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto row = std::find(table.rows.begin(), table.rows.end(), recordings[i].split) - table.rows.begin();
    if (row == std::ssize(table.rows)) {
      table.rows.push_back(recordings[i].split);
      table.cells.push_back({0});
    }
    table.cells[static_cast<std::size_t>(row)][0] += 1;
  }
  std::vector<std::string> needed = train;
  if (!evaluate.empty()) needed.push_back(evaluate);
  for (const auto& split : needed)
    if (std::find(table.rows.begin(), table.rows.end(), split) == table.rows.end())
      throw std::runtime_error(fmt::format("no recording belongs to the split \"{}\"{}; there are: {}", split,
                                           did_you_mean(split, table.rows), fmt::join(table.rows, ", ")));
  if (std::find(train.begin(), train.end(), evaluate) != train.end())
    throw std::runtime_error(
        fmt::format("the split \"{}\" is trained on and scored: what was trained on scores too well", evaluate));
  return table;
}

void describe(Description<Splits>& d) {
  d.type("corpus.splits").summary("counts the recordings of each split; those to train on and to score must have some");
  d.input("recordings", "of all splits").output("table", "recordings of each split, a row each");
  d.param("train", &Splits::train).doc("splits to train on");
  d.param("evaluate", &Splits::evaluate).doc("split to score; empty: none");
}

}  // namespace talkgraph
