#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/prototypes.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// All prototypes with their landmarks on one sheet, a PNG in the run folder.
struct PrototypeSheet {
  int columns = 12;
  int width = 120;  ///< of one picture, pixels
  std::string name = "prototypes";

  Artifact operator()(const Prototypes& prototypes, Context& context) const;
};
void describe(Description<PrototypeSheet>& d);

/// Prototypes on their way through a face model, a row each, evenly chosen:
/// the picture, its landmarks, the triangles between them, and the face that
/// the model makes of it (thesis Figures 3.5 and 3.6). A PNG in the run folder.
struct ModelSheet {
  int rows = 3;
  int width = 240;  ///< of one picture, pixels
  std::string name = "reconstructions";

  Artifact operator()(const AppearanceModel& model, const Prototypes& prototypes, Context& context) const;
};
void describe(Description<ModelSheet>& d);

}  // namespace talkgraph
