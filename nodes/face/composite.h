#pragma once

#include "graph/description.h"
#include "nodes/face/part.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/base_clip.h"
#include "nodes/types/eyes.h"
#include "nodes/types/mouths.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// How the synthesised face joins the base picture.
enum class Seam { feather, poisson };
template <>
inline constexpr EnumNames<Seam, 2> enum_names<Seam>{{{Seam::feather, "feather"}, {Seam::poisson, "poisson"}}};

/// Draws a synthesised face on the frames of a base clip at their tracked
/// pose. The base picture is bent to the new landmarks, and what the synthesised
/// texture differs from the base's own modelled texture is added to it, so that
/// skin keeps its grain and light; where the texture changes
/// most (the inner mouth) and at real mouths the synthesised texture replaces the base's.
/// Towards the face's edge the change fades out (feather), or it is added all over, less the smooth field that is
/// it at the edge (poisson: the gradients of the new face, the base around it; Pérez et al. 2003).
/// A base shorter than the track is run back and forth; only its longest
/// stretch without lost frames is used. The video has the track's rate and
/// length and renders when read. Throws std::runtime_error if the base has no
/// good frame, or parameters, eyes or mouths do not fit the model or each other. docs/method.md §2.
struct CompositeFace {
  FacePart part = FacePart::lower;
  double blend_from = 0.40;  ///< of the face's height from the top: above this the base stays (part "lower")
  double blend_to = 0.56;    ///< below this the parameters rule
  Seam seam = Seam::feather;
  double feather = 0.06;  ///< blend at the face's edge, share of its width

  Video operator()(const AppearanceModel& model, const Track& parameters, const BaseClip& base, const Eyes* eyes,
                   const MouthTrack* mouths) const;
};
void describe(Description<CompositeFace>& d);

}  // namespace talkgraph
