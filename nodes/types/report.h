#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A table of numbers: rows are named, as are columns. NaN marks "no value".
struct Table {
  std::string title;
  std::string corner;  ///< heading of the row names: "method"
  std::vector<std::string> columns;
  std::vector<std::string> rows;
  std::vector<std::vector<double>> cells;  ///< cells[row][column]
};
template <>
inline constexpr PortType port_type<Table>{"Table", 1};
void fields(Archive& ar, Table& t);

/// Named numbers of one sequence: {"amse": 0.31, "acc": 0.64}.
struct Scores {
  std::map<std::string, double> values;
};
template <>
inline constexpr PortType port_type<Scores>{"Scores", 1};
void fields(Archive& ar, Scores& s);

/// A picture as SVG text with its caption.
struct Plot {
  std::string title;
  std::string svg;
};
template <>
inline constexpr PortType port_type<Plot>{"Plot", 1};
void fields(Archive& ar, Plot& p);

/// A file that a node wrote, relative to the run folder.
struct Artifact {
  std::string path;
  std::string title;
};
template <>
inline constexpr PortType port_type<Artifact>{"Artifact", 1};
void fields(Archive& ar, Artifact& a);

}  // namespace talkgraph
