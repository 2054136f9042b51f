#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/slds.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The stream whose phones are sought.
enum class SldsStream { visual, audio };
template <>
inline constexpr EnumNames<SldsStream, 2> enum_names<SldsStream>{
    {{SldsStream::visual, "visual"}, {SldsStream::audio, "audio"}}};

/// The phones of a face, or of sound, whose labels are unknown, by approximate Viterbi: for each phone of each frame
/// only the likeliest path to it is kept, with what a Kalman filter along it knows of the state. Lost frames count as
/// not observed; no frames give no labels. Throws std::runtime_error on another dimension than the model's, on values
/// that are not finite, on sound where the system gives the face alone, and where states that grow without bound
/// overflow; as LdsFilter too.
struct DecodeSlds {
  SldsStream stream = SldsStream::visual;

  FrameLabels operator()(const Slds& model, const Track& track, Context& context) const;
};
void describe(Description<DecodeSlds>& d);

}  // namespace talkgraph
