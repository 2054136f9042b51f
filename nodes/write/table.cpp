#include "nodes/write/table.h"

#include "graph/output_file.h"
#include "nodes/types/item_file.h"
#include "nodes/write/text.h"

namespace talkgraph {

Artifact WriteTable::operator()(const Table& table, Context& context) const {
  const auto file = [&](const char* ending) {
    return item_file(context, context.item.empty() ? "" : name, ending, name).path;
  };
  write_file(context.file(file(".json")), to_json(table));
  write_file(context.file(file(".csv")), to_csv(table));
  return {file(".csv"), table.title.empty() ? "table" : table.title};
}

void describe(Description<WriteTable>& d) {
  d.type("write.table").summary("writes a table as CSV and JSON").sink();
  d.input("table", "what is written").output("file", "the CSV file; the JSON file lies beside it");
  d.param("name", &WriteTable::name).doc("file name without its ending; of a stream, the folder");
}

}  // namespace talkgraph
