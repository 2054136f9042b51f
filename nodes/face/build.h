#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/prototypes.h"

namespace talkgraph {

/// Active appearance model of the prototypes: Procrustes alignment, Delaunay
/// triangles (unless the point scheme has its own), colour texture warped to a shape whose
/// mouth is open if the scheme names the inner lips (inner_top, inner_bottom), else to the mean, PCA of shapes, of
/// textures and of both, and the matrices that fitting uses (docs/method.md §2, Eqns
/// 3.11-3.21). Throws std::runtime_error on no prototypes, point counts that
/// differ, a landmark that is not a number, or a flat picture. A single
/// prototype gives a rigid model without modes.
struct BuildAppearance {
  double width = 120;  ///< of the mean shape, pixels; never more than the prototypes' own
  double retain_shape = 0.99;
  double retain_texture = 0.99;
  double retain_combined = 0.99;
  int levels = 3;  ///< of the fitting pyramid

  AppearanceModel operator()(const Prototypes& prototypes, Context& context) const;
};
void describe(Description<BuildAppearance>& d);

}  // namespace talkgraph
