#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/gpdm.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class GpdmStart {
  nearest,         ///< of each frame the training point that gives the nearest frame
  back_constraint  ///< that of the model
};
template <>
inline constexpr EnumNames<GpdmStart, 2> enum_names<GpdmStart>{
    {{GpdmStart::nearest, "nearest"}, {GpdmStart::back_constraint, "back_constraint"}}};

/// Latent points of a track under a trained GPDM or GPLVM, and the track that they give: from start values, every run
/// of measured frames is optimised as a sequence (SequenceObjective). Lost frames stay at 0, the prior's mean, and are
/// marked.
///
/// Throws std::runtime_error on other dimensions than the model's, on values that are not finite, if the model lacks
/// the back-constraint to start from, and where the likelihood is not finite.
struct InferGpdm {
  struct Out {
    Track latents;    ///< T × d
    Track track;      ///< mean of the observations there, T × D
    Track deviation;  ///< their standard deviation, noise included, T × D
  };
  GpdmStart initial = GpdmStart::nearest;
  bool dynamics = true;
  int iterations = 100;

  Out operator()(const Gpdm& model, const Track& track, Context& context) const;
};
void describe(Description<InferGpdm>& d);

}  // namespace talkgraph
