#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"
#include "nodes/types/voice_puppetry.h"

namespace talkgraph {

/// The face that sound moves: the likeliest path through the states by their sound, then the trajectory that is
/// likeliest on this path, frames and velocities (one banded linear system). Frames of the sound that are lost count as
/// not heard. Throws std::runtime_error on another audio dimension than the model's, and on values that are not finite.
/// No frames give no frames.
struct SynthesiseVoicePuppetry {
  Track operator()(const VoicePuppetry& model, const Track& audio) const;
};
void describe(Description<SynthesiseVoicePuppetry>& d);

}  // namespace talkgraph
