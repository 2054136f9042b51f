#pragma once

#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/mouths.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// A real mouth for every frame of a trajectory of appearance parameters: the
/// sequence that follows it most closely without jumps. Minimises, by Viterbi over the `candidates`
/// nearest mouths of each frame,
///   Σ_t d²(c_t, c_m(t)) + smoothness · Σ_t |g_m(t) − g_m(t−1)|²
/// d the difference of the modelled mouths (texture, and shape by the model's weight), g the real textures.
/// Gives no mouths where there are none to choose from. Throws std::runtime_error if trajectory or mouths were made
/// with another model, or a parameter is not finite.
struct SelectMouths {
  double smoothness = 0.03;
  int candidates = 40;

  MouthTrack operator()(const AppearanceModel& model, const Mouths& mouths, const Track& parameters) const;
};
void describe(Description<SelectMouths>& d);

}  // namespace talkgraph
