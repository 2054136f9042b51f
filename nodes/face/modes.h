#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// The first modes of a face model, a row each: minus `deviations` standard
/// deviations, half of that, the mean, and the same upwards (Appendix B).
/// Writes a PNG in the run folder.
struct FaceModes {
  int modes = 6;
  double deviations = 2;
  std::string name = "modes";

  Artifact operator()(const AppearanceModel& model, Context& context) const;
};
void describe(Description<FaceModes>& d);

}  // namespace talkgraph
