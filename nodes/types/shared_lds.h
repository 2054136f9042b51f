#pragma once

#include "nodes/types/lds.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// A linear dynamical system that gives audio and visual features (Eqns 4.57-4.64). Its frames are both side by side,
/// scaled, audio first; their noises are independent of each other.
struct SharedLds {
  Scaling audio, visual;
  Lds system;
};
template <>
inline constexpr PortType port_type<SharedLds>{"SharedLds", 1};
void fields(Archive& ar, SharedLds& s);

}  // namespace talkgraph
