#pragma once

#include <vector>

#include "nodes/types/track.h"

namespace talkgraph {

/// Whose eyes a drawn face shows, frame by frame.
struct Eyes {
  Track parameters;         ///< appearance parameters c, T × modes
  std::vector<int> points;  ///< landmarks of the eyes
  std::vector<int> nose;    ///< further landmarks that are carried along
};
template <>
inline constexpr PortType port_type<Eyes>{"Eyes", 1};
void fields(Archive& ar, Eyes& e);

}  // namespace talkgraph
