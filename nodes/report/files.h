#pragma once

#include <filesystem>
#include <string_view>

#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a file by way of a temporary one, folders made as needed. Throws
/// std::runtime_error that names the file.
void write_whole(const std::filesystem::path& file, std::string_view text);

std::string to_csv(const Table& table);
/// {"title", "columns", "rows": {name: {column: number or null}}}
std::string to_json(const Table& table);

}  // namespace talkgraph
