#pragma once

#include <string>
#include <vector>

#include "nodes/types/hmm.h"

namespace talkgraph {

/// Hidden Markov models of phones or visemes as they are seen, in one network: from the states of one unit ways lead to
/// the first states of every other.
struct LipReader {
  std::vector<std::string> units;     ///< phones, or visemes "1" to "14"; "sil" for pauses
  std::vector<std::int64_t> unit_of;  ///< number of each state's unit
  bool visemes = false;               ///< what the units are
  Hmm network;
};
template <>
inline constexpr PortType port_type<LipReader>{"LipReader", 1};
/// Throws std::runtime_error if members that were loaded do not fit together.
void fields(Archive& ar, LipReader& r);

}  // namespace talkgraph
