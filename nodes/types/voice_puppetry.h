#pragma once

#include "nodes/types/hmm.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// Brand's voice puppetry: states of the face, and what they sound like.
struct VoicePuppetry {
  Scaling audio;
  Scaling visual;
  Hmm states;                           ///< of scaled visual frames beside their velocities, 2 D_Z dimensions
  std::vector<GaussianMixture> sounds;  ///< a Gaussian of scaled audio frames for each state
};
template <>
inline constexpr PortType port_type<VoicePuppetry>{"VoicePuppetry", 1};
void fields(Archive& ar, VoicePuppetry& v);

}  // namespace talkgraph
