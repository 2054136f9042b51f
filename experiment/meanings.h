#pragma once

#include <string>
#include <vector>

#include "graph/graph.h"

namespace talkgraph {

/// What a measure is.
struct Meaning {
  std::string measure, text;
  bool operator==(const Meaning&) const = default;
};

/// Of the measures, each that the graphs' nodes explain where they describe an output of scores or a table: "lmd:
/// distance of lip points, px; x won: sequences". There "x won" stands for every measure whose name ends in " won". Of
/// several descriptions the first counts.
std::vector<Meaning> meanings_of(const std::vector<std::string>& measures, const std::vector<Graph>& graphs);

/// Folded, a line each; nothing if there are none.
std::string html_meanings(const std::vector<Meaning>& meanings);

}  // namespace talkgraph
