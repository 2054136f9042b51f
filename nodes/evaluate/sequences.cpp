#include "nodes/evaluate/sequences.h"

#include <cmath>

namespace talkgraph {

Table SequenceTable::operator()(const Collected<Scores>& all) const {
  Table table{title, "sequence", scores, all.keys(), {}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> row;
    for (const auto& name : scores) {
      const auto it = all[i].values.find(name);
      row.push_back(it == all[i].values.end() ? NAN : it->second);
    }
    table.cells.push_back(std::move(row));
  }
  return table;
}

void describe(Description<SequenceTable>& d) {
  d.type("evaluate.sequences").summary("the scores of each sequence as a table").source("Thesis §6.2");
  d.input("scores", "of each sequence").output("table", "one row a sequence");
  d.param("scores", &SequenceTable::scores)
      .doc("which, in the order of the columns; one that no sequence has is an empty column");
  d.param("title", &SequenceTable::title).doc("heading of the table");
}

}  // namespace talkgraph
