#include "nodes/report/write_table.h"

#include "graph/output_file.h"
#include "nodes/report/files.h"

namespace talkgraph {

Artifact WriteTable::operator()(const Table& table, Context& context) const {
  write_file(context.folder / (name + ".json"), to_json(table));
  write_file(context.folder / (name + ".csv"), to_csv(table));
  return {name + ".csv", table.title.empty() ? "table" : table.title};
}

void describe(Description<WriteTable>& d) {
  d.type("report.write_table").summary("writes a table as CSV and JSON").sink();
  d.input("table", "what is written").output("file", "the CSV file; the JSON file lies beside it");
  d.param("name", &WriteTable::name).doc("file name without its ending");
}

}  // namespace talkgraph
