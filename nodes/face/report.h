#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/prototypes.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// What a face model keeps, and how well it shows pictures that it was not
/// built from. All pictures are projected on its modes with their landmarks
/// given; no fit is made. Throws std::runtime_error on no pictures, or other
/// landmarks than the model's.
struct FaceReport {
  struct Out {
    /// A row a stage (shape, texture, combined): modes, and the share of the training pictures' variance that they
    /// hold. Combined: of what the two stages before it kept.
    Table stages;
    /// A row a mode: share of its stage's variance, and of all modes up to it. NaN where a stage has fewer modes.
    Table modes;
    /// Rows training and unseen: pictures; landmarks, px; texture, grey levels (both root mean square over all);
    /// PSNR, dB (of the mean square error of all); and those of the worst picture.
    Table errors;
  };
  Out operator()(const AppearanceModel& model, const Prototypes& training, const Prototypes& unseen,
                 Context& context) const;
};
void describe(Description<FaceReport>& d);

}  // namespace talkgraph
