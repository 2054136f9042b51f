#pragma once

#include <string>

#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// A cell, in quotes where it needs them.
std::string csv_text(const std::string& text);
/// A heading and a line a row; no value is an empty cell.
std::string to_csv(const Table& table);
/// A heading (the track's names, or d0, d1, ...) and a line a frame, every digit kept.
std::string to_csv(const Track& track);
/// {"title", "columns", "rows": {name: {column: number or null}}}. Throws std::invalid_argument if two rows, or two
/// columns, have one name.
std::string to_json(const Table& table);

}  // namespace talkgraph
