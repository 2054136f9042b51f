#pragma once

#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/base_clip.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What a synthesised face takes from the parameters; the rest stays the base's.
enum class FacePart { lower, whole };
template <>
inline constexpr EnumNames<FacePart, 2> enum_names<FacePart>{{{FacePart::lower, "lower"}, {FacePart::whole, "whole"}}};

/// Draws a synthesised face on the frames of a base clip at their tracked
/// pose. The base picture is bent to the new landmarks, and what the synthesised
/// texture differs from the base's own modelled texture is added to it, so that
/// skin keeps its grain and light and no seam arises; where the texture changes
/// most (the inner mouth) the synthesised texture replaces the base's.
/// A base shorter than the track is run back and forth; only its longest
/// stretch without lost frames is used. The video has the track's rate and
/// length and renders when read. Throws std::runtime_error if the base has no
/// good frame or the track was made with another model. docs/method.md §2.
struct CompositeFace {
  FacePart part = FacePart::lower;
  double blend_from = 0.40;  ///< of the face's height from the top: above this the base stays (part "lower")
  double blend_to = 0.56;    ///< below this the parameters rule
  double feather = 0.06;     ///< blend at the face's edge, share of its width

  Video operator()(const AppearanceModel& model, const Track& parameters, const BaseClip& base) const;
};
void describe(Description<CompositeFace>& d);

}  // namespace talkgraph
