#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/independent_components.h"
#include "nodes/types/report.h"

namespace talkgraph {

enum class ModeKind { combined, shape, texture };
template <>
inline constexpr EnumNames<ModeKind, 3> enum_names<ModeKind>{
    {{ModeKind::combined, "combined"}, {ModeKind::shape, "shape"}, {ModeKind::texture, "texture"}}};

/// The first modes of a face model, a row each: minus `deviations` standard
/// deviations, half of that, the mean, and the same upwards (Appendix B). A
/// mode of shape is shown with the mean texture, one of texture on the mean
/// shape. With independent components of its appearance parameters these take
/// the place of the combined modes (Appendix C). Writes a PNG in the run
/// folder. Throws std::runtime_error if components are of another model, or
/// given with `of` other than combined.
struct FaceModes {
  ModeKind of = ModeKind::combined;
  int modes = 6;
  int across = 1;  ///< modes beside each other
  double deviations = 2;
  double zoom = 1.5;
  std::string name = "modes";

  Artifact operator()(const AppearanceModel& model, const IndependentComponents* components, Context& context) const;
};
void describe(Description<FaceModes>& d);

}  // namespace talkgraph
