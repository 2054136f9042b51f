#include "nodes/write/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace talkgraph {

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

namespace {

void check_distinct(std::vector<std::string> names, const char* what) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end())
    throw std::invalid_argument(
        fmt::format("a table has two {} called \"{}\"; JSON keeps one of a name", what, *twice));
}

}  // namespace

std::string to_csv(const Table& table) {
  std::string out = csv_text(table.corner);
  for (const auto& column : table.columns) out += "," + csv_text(column);
  out += "\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    out += csv_text(table.rows[r]);
    for (const double v : table.cells[r]) out += std::isnan(v) ? "," : fmt::format(",{}", v);
    out += "\n";
  }
  return out;
}

std::string to_csv(const Track& track) {
  std::string out;
  for (Eigen::Index d = 0; d < track.dimension(); ++d)
    out += (d ? "," : "") +
           (track.names.empty() ? fmt::format("d{}", d) : csv_text(track.names[static_cast<std::size_t>(d)]));
  out += "\n";
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    for (Eigen::Index d = 0; d < track.dimension(); ++d) out += fmt::format("{}{}", d ? "," : "", track.values(t, d));
    out += "\n";
  }
  return out;
}

std::string to_json(const Table& table) {
  check_distinct(table.rows, "rows");
  check_distinct(table.columns, "columns");
  nlohmann::ordered_json out = {
      {"title", table.title}, {"columns", table.columns}, {"rows", nlohmann::ordered_json::object()}};
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    auto& row = out["rows"][table.rows[r]] = nlohmann::ordered_json::object();
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      row[table.columns[c]] = std::isfinite(table.cells[r][c]) ? nlohmann::ordered_json(table.cells[r][c]) : nullptr;
  }
  return out.dump(2);
}

}  // namespace talkgraph
