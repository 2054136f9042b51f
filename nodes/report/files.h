#pragma once

#include <string>

#include "nodes/types/report.h"

namespace talkgraph {

/// A heading and a line a row; no value is an empty cell.
std::string to_csv(const Table& table);
/// {"title", "columns", "rows": {name: {column: number or null}}}
std::string to_json(const Table& table);

}  // namespace talkgraph
