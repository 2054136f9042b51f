#pragma once

#include <string>
#include <vector>

#include "nodes/types/track.h"

namespace talkgraph {

/// One curve a sequence, of what one method or the recording gives.
struct Curves {
  std::vector<std::string> keys;
  std::vector<Track> curves;  ///< T × 1 each
};
template <>
inline constexpr PortType port_type<Curves>{"Curves", 1};
void fields(Archive& ar, Curves& c);

}  // namespace talkgraph
