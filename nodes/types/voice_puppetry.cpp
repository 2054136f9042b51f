#include "nodes/types/voice_puppetry.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const VoicePuppetry& v) {
  const StoredModel stored("voice puppetry");
  stored.scaling("audio", v.audio, v.audio.mean.size());
  stored.scaling("visual", v.visual, v.visual.mean.size());
  for (const auto& face : v.states.observations)
    stored.require(face.components() == 1 && face.dimension() == 2 * v.visual.mean.size(), "states",
                   "are no Gaussians of visual frames and their velocities");
  stored.mixtures("sounds", v.sounds, v.states.states(), v.audio.mean.size());
}

}  // namespace

void fields(Archive& ar, VoicePuppetry& v) {
  ar("audio", v.audio);
  ar("visual", v.visual);
  ar("states", v.states);
  ar("sounds", v.sounds);
  if (ar.loading()) check(v);
}

}  // namespace talkgraph
