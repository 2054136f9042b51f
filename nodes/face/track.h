#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/face/fit.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Follows the face through a clip with the model alone. The first frame is
/// searched on a grid of mean-shape windows, later ones start from the last
/// good one, doubtful fits from all sides of it too; where the residual exceeds the threshold the frame is searched
/// anew, and if that fails it is lost, with confidence 0. Lost and damaged frames get parameters
/// and pose interpolated between their good neighbours (copied at the ends);
/// with no good frame at all, the mean face in the middle of the picture.
/// Throws std::runtime_error on a clip without frames. docs/method.md §2, Algorithm 1.
struct TrackFace {
  FitMethod fitter = FitMethod::fixed_jacobian;
  double lost_above = 6;     ///< residual at the prototypes' average light, in multiples of the model's own residual
                             ///< over its prototypes (taken as at least 4/3 grey levels)
  int iterations = 10;       ///< at most, per pyramid level
  double tolerance = 1e-3;   ///< relative gain under which a fit ends
  double reach = 0.1;        ///< a doubtful fit is tried again from so far on all four sides, half widths of the face
  double scale_range = 1.6;  ///< the search covers the prototypes' average size divided and multiplied by this
  int candidates = 6;        ///< windows that the search fits

  FaceTrack operator()(const AppearanceModel& model, const Video& video, Context& context) const;
};
void describe(Description<TrackFace>& d);

}  // namespace talkgraph
