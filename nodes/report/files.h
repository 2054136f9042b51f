#pragma once

#include <filesystem>
#include <string_view>

#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a file by way of a temporary one, folders made as needed, so that it
/// is never seen half written. Throws std::runtime_error that names the file.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// A heading and a line a row; no value is an empty cell.
std::string to_csv(const Table& table);
/// {"title", "columns", "rows": {name: {column: number or null}}}
std::string to_json(const Table& table);

}  // namespace talkgraph
