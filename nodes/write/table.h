#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a table as NAME.csv and NAME.json below the run folder, those of a stream as NAME/ITEM. Errors: a file
/// cannot be written, two rows have one name.
struct WriteTable {
  std::string name = "table";

  Artifact operator()(const Table& table, Context& context) const;
};
void describe(Description<WriteTable>& d);

}  // namespace talkgraph
